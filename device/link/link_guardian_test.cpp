// The link and its guardian: who proves nothing is refused, who lives no more is missed, and close() says what was left
// on the device.

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>

#include "device/testing/link_bench.h"
#include "device/testing/test_files.h"

namespace palpate::device {
namespace {

/// A guardian that is the test's own.
struct OwnGuardian {
  GuardianBeat beat;
  bool proves = true;

  OwnGuardian() { beat.reach = GuardianReach::at_any_time; }
  LinkStylusOptions options() {
    LinkStylusOptions options;
    options.guardian_patience = 0;
    options.start_guardian = [this](const GuardianSettings&) {
      beat.proof = proves ? proof_for(beat.challenge) : 0;
      return std::make_unique<Guardian>(0, -1, &beat);
    };
    return options;
  }
};

/// Pushes for so long, while the guardian lives.
void push_guarded(LinkBench& bench, LinkStylus& stylus, OwnGuardian& guardian, double seconds) {
  for (const double end = bench.time + seconds; bench.time < end;) {
    push(bench, stylus, 2, 0.1);
    ++guardian.beat.lives;
  }
}

TEST(LinkGuardian, WithoutAProofTheDeviceIsNotEvenOpened) {
  LinkBench bench;
  OwnGuardian guardian;
  guardian.proves = false;
  EXPECT_THROW(unthreaded(bench, guardian.options()), std::runtime_error);
  EXPECT_EQ(bench.open, 0);
  guardian.proves = true;
  const auto stylus = unthreaded(bench, guardian.options());
  EXPECT_EQ(bench.open, 1);
  EXPECT_NE(stylus->specification().guardian.find("takes the force away within"), std::string::npos);
  EXPECT_EQ(unthreaded(bench)->specification().guardian, "") << "without one";
}

TEST(LinkGuardian, OneThatCanDoNothingIsRefusedAndTheDeviceClosed) {
  for (const GuardianReach reach : {GuardianReach::none, GuardianReach::untold}) {
    LinkBench bench;
    OwnGuardian guardian;
    guardian.beat.reach = reach;
    EXPECT_THROW(unthreaded(bench, guardian.options()), std::runtime_error);
    EXPECT_EQ(bench.open, 0);
  }
}

TEST(LinkGuardian, ItsSilenceForHalfASecondIsAFault) {
  LinkBench bench;
  OwnGuardian guardian;
  const auto stylus = unthreaded(bench, guardian.options());
  push_guarded(bench, *stylus, guardian, 3);
  EXPECT_EQ(stylus->fault(), LinkFault::none);
  EXPECT_NE(bench.force, Vec3(0));
  const double died = bench.time;
  while (bench.force != Vec3(0) && bench.time < died + 5) push(bench, *stylus, 2, 1e-3);
  EXPECT_EQ(stylus->fault(), LinkFault::unguarded);
  EXPECT_NE(stylus->trouble().find("guardian"), std::string::npos);
  EXPECT_GT(bench.time - died, ceiling::guardian_s - 0.11);
  EXPECT_LT(bench.time - died, ceiling::guardian_s + 0.01);
  ++guardian.beat.lives;
  push_guarded(bench, *stylus, guardian, 1);
  EXPECT_EQ(bench.force, Vec3(0)) << "it stays a fault";
  stylus->close();
  stylus->open();
  push_guarded(bench, *stylus, guardian, 1);
  EXPECT_NE(bench.force, Vec3(0));
}

TEST(LinkGuardian, BeforeASleepTheForceGoes) {
  LinkBench bench;
  OwnGuardian guardian;
  const auto stylus = unthreaded(bench, guardian.options());
  push_guarded(bench, *stylus, guardian, 1);
  guardian.beat.sleep_is_near = true;
  push(bench, *stylus, 2, 0.01);
  EXPECT_EQ(stylus->fault(), LinkFault::slept);
  EXPECT_EQ(bench.force, Vec3(0));
  EXPECT_EQ(guardian.beat.on_device, OnDevice::zero_taken) << "which lets the machine sleep";
}

/// 'q' where the device has taken a zero; 'w' where it is gone, or its answer never came, with a force on it.
TEST(LinkGuardian, CloseSaysWhetherAForceMayBeLeft) {
  enum class End { in_order, unplugged, refuses, silent };
  for (const End end : {End::in_order, End::unplugged, End::refuses, End::silent}) {
    const TestFiles files;
    const std::string told = files.write("told", "");
    LinkBench bench;
    LinkStylusOptions options;
    options.start_guardian = [&](const GuardianSettings&) {
      return proved(start_guardian({.program = "/bin/sh", .kind = "-c", .address = "cat > " + told}));
    };
    const auto stylus = unthreaded(bench, options);
    push(bench, *stylus, 2, 0.4);
    bench.lost = end == End::unplugged;
    bench.speaks = end != End::silent;
    if (end == End::refuses) bench.answer = ForceAnswer::refused;
    stylus->service(1e-3);
    stylus->close();
    std::ifstream file(told);
    const std::string word{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(word, end == End::in_order ? "q" : "w") << static_cast<int>(end);
  }
}

}  // namespace
}  // namespace palpate::device
