#include "device/link/given_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "device/link/lock_step.h"
#include "device/testing/link_bench.h"
#include "device/testing/test_files.h"

namespace palpate::device {
namespace {

constexpr double tick_s = 1e-3;

Vec3 random_force(std::mt19937_64& random, double most) {
  std::uniform_real_distribution<double> any(-most, most);
  return {any(random), any(random), any(random)};
}

/// A device that holds its force while it gets none, or one that lets it go after a refusal or 20 ms without a force.
class ModelDevice {
 public:
  explicit ModelDevice(bool lets_go) : lets_go_(lets_go) {}
  Vec3 force{0};
  void take(ForceAnswer answer, const Vec3& given, double now) {
    if (answer == ForceAnswer::taken) force = given;
    if (answer == ForceAnswer::withheld || (answer == ForceAnswer::refused && lets_go_)) force = Vec3(0);
    if (answer == ForceAnswer::waiting && lets_go_ && now - time_ > 0.0205) force = Vec3(0);
    if (answer != ForceAnswer::waiting) time_ = now;
  }

 private:
  bool lets_go_;
  double time_ = 0;
};

/// Whatever is asked for, withheld, refused or late: a force that is given differs from the one on the device by no
/// more than the slew ceiling allows, or is zero.
TEST(GivenForce, NoStepAboveTheSlewCeilingReachesADevice) {
  for (const bool lets_go : {false, true}) {
    for (unsigned seed = 0; seed < 300; ++seed) {
      std::mt19937_64 random(seed);
      std::uniform_real_distribution<double> chance(0, 1);
      GivenForce given;
      ModelDevice device(lets_go);
      given.start(0);
      double now = 0, taken = 0;
      Vec3 wanted(0);
      for (int n = 0; n < 600; ++n) {
        now += chance(random) < 0.02 ? 0.3 * chance(random) : 2 * tick_s * chance(random);
        if (chance(random) < 0.1) wanted = random_force(random, chance(random) < 0.2 ? 1e9 : 4);
        const double kind = chance(random);
        const ForceAnswer answer = kind < 0.8    ? ForceAnswer::taken
                                   : kind < 0.96 ? ForceAnswer::waiting
                                   : kind < 0.98 ? ForceAnswer::withheld
                                                 : ForceAnswer::refused;
        const Vec3 force = given.next(wanted, chance(random) < 0.02, now);
        ASSERT_LE(glm::length(force), ceiling::force_n * (1 + 1e-12));
        const double most = ceiling::slew_n_per_s * std::min(now - taken, ceiling::slew_time_s) * (1 + 1e-9) + 1e-12;
        if (answer == ForceAnswer::taken) {
          const double step = force == Vec3(0) ? 0 : glm::length(force - device.force);
          ASSERT_LE(step, most) << "seed " << seed << ", exchange " << n;
        }
        given.while_giving(force, static_cast<std::uint64_t>(n));
        given.answered(answer, force, static_cast<std::uint64_t>(n), now);
        device.take(answer, force, now);
        if (answer != ForceAnswer::waiting) taken = now;
      }
    }
  }
}

/// A device may hold the force of a program that was killed: whatever is asked for in the moment when it is opened, the
/// first force that it takes is a zero, and the ramp begins there.
TEST(GivenForce, OpenedItBeginsWithAZeroAndARamp) {
  for (const double first : {0.0, 0.5e-3, 0.019, 0.3}) {
    for (const int waits : {0, 1, 30}) {
      GivenForce given;
      given.start(7);
      double now = 7 + first;
      for (int n = 0; n < waits; ++n, now += tick_s) {
        given.answered(ForceAnswer::waiting, given.next(Vec3(0, 3, 0), false, now), 0, now);
      }
      const double began = now;
      for (int n = 0; n < 400; ++n, now += tick_s) {
        const Vec3 force = given.next(Vec3(0, 3, 0), false, now);
        given.answered(ForceAnswer::taken, force, 0, now);
        if (n == 0) {
          EXPECT_EQ(force, Vec3(0));
        }
        EXPECT_NEAR(force.y, 3 * std::min(1.0, (now - began) / ceiling::resume_ramp_s), 1e-9) << n;
      }
    }
  }
}

/// After a zero for any reason and of any length the force comes back along the ramp, and whole.
TEST(GivenForce, EveryZeroThatIsPutInIsFollowedByARamp) {
  for (const ForceAnswer cause :
       {ForceAnswer::taken, ForceAnswer::waiting, ForceAnswer::withheld, ForceAnswer::refused}) {
    for (const double seconds : {0.001, 0.03, 0.2}) {
      if (cause == ForceAnswer::waiting && seconds < ceiling::link_force_age_s) continue;
      GivenForce given;
      given.start(0);
      double now = 0;
      const Vec3 wanted(0, 3, 0);
      const auto exchange = [&](ForceAnswer answer, bool withheld) {
        now += tick_s;
        const Vec3 force = given.next(wanted, withheld, now);
        given.answered(answer, force, 0, now);
        return force;
      };
      for (int n = 0; n < 1000; ++n) exchange(ForceAnswer::taken, false);
      ASSERT_EQ(given.given(), wanted);
      for (double passed = 0; passed < seconds; passed += tick_s) exchange(cause, cause == ForceAnswer::taken);
      const double back = now;
      bool whole = false;
      for (int n = 0; n < 400; ++n) {
        const double length = glm::length(exchange(ForceAnswer::taken, false));
        const bool falls = cause == ForceAnswer::taken && n < 3;  // what is slewed down meets the ramp
        if (!falls) {
          EXPECT_LE(length, 3 * (now - back + tick_s) / ceiling::resume_ramp_s + 1e-9);
        }
        whole = now - back > ceiling::resume_ramp_s + tick_s;
        if (whole) {
          EXPECT_NEAR(length, 3, 1e-9);
        }
      }
      EXPECT_TRUE(whole);
    }
  }
}

/// A zero lies on the device only after the second pose that follows the first zero in a row.
TEST(GivenForce, AZeroCountsWhenTheDeviceHasTakenIt) {
  for (const int poses : {0, 1, 2, 5}) {
    GivenForce given;
    given.start(0);
    const auto give = [&](const Vec3& force, std::uint64_t news, ForceAnswer answer = ForceAnswer::taken) {
      const OnDevice told = given.while_giving(force, news);
      given.answered(answer, force, news, 0);
      return told;
    };
    EXPECT_EQ(given.on_device(), OnDevice::unknown) << "nobody knows what was left on it";
    EXPECT_EQ(give(Vec3(0, 1, 0), 100), OnDevice::pushing);
    EXPECT_EQ(give(Vec3(0), 101, ForceAnswer::waiting), OnDevice::pushing);
    EXPECT_EQ(give(Vec3(0), 110), OnDevice::pushing) << "the one that waited does not count";
    const OnDevice told = give(Vec3(0), static_cast<std::uint64_t>(110 + poses));
    EXPECT_EQ(told, poses < 2 ? OnDevice::pushing : OnDevice::zero_taken);
    given.doubt();
    EXPECT_EQ(given.on_device(), poses < 2 ? OnDevice::unknown : OnDevice::zero_taken);
    EXPECT_EQ(give(Vec3(1e-9, 0, 0), 200, ForceAnswer::refused), OnDevice::pushing);
    EXPECT_EQ(given.on_device(), OnDevice::unknown);
    EXPECT_EQ(give(Vec3(0), 300), OnDevice::unknown);
    EXPECT_EQ(give(Vec3(0), 302), OnDevice::zero_taken);
  }
}

/// The largest change between two forces on the device.
double largest_step(const std::vector<Vec3>& forces) {
  double step = 0;
  for (std::size_t n = 1; n < forces.size(); ++n) step = std::max(step, glm::length(forces[n] - forces[n - 1]));
  return step;
}

/// 3 N, 0 and 3 N again in one exchange: that was so with a servo late by 20 to 100 ms.
TEST(GivenForce, AServoThatIsLateMakesNoStepAndARampFollows) {
  for (const double late_s : {0.005, 0.020, 0.021, 0.050, 0.100, 0.150, 0.200}) {
    LinkBench bench;
    const auto stylus = unthreaded(bench);
    push(bench, *stylus, 3, 0.5);
    ASSERT_NEAR(bench.force.y, 3, 1e-9);
    bench.forces.clear();
    for (double passed = 0; passed < late_s; passed += tick_s) stylus->service(tick_s);
    const bool taken_away = glm::length(bench.force) < 1e-9;
    EXPECT_EQ(taken_away, late_s > 0.03) << late_s;
    push(bench, *stylus, 3, 0.5);
    EXPECT_NEAR(bench.force.y, 3, 1e-9);
    EXPECT_LE(largest_step(bench.forces), ceiling::slew_n_per_s * tick_s + 1e-9) << late_s;
    EXPECT_EQ(stylus->fault(), LinkFault::none);
  }
}

/// A hand that trembles at the edge of the reach: 1000 jumps between 0 and 3 N in two seconds were so.
TEST(GivenForce, ADoubtfulPoseHoldsTheForceThenLetsItFallAndRamps) {
  for (const int period : {2, 10, 37, 100, 300}) {  // ms
    LinkBench bench;
    const auto stylus = unthreaded(bench);
    push(bench, *stylus, 3, 0.5);
    bench.forces.clear();
    int rises = 0;
    for (int n = 0; n < 2000; ++n) {
      bench.doubtful = n % period < period / 2;
      const Vec3 before = bench.force;
      push(bench, *stylus, 3, 0.9 * tick_s);
      rises += glm::length(bench.force) > glm::length(before) + 0.1 ? 1 : 0;
    }
    EXPECT_EQ(rises, 0) << period << " ms: it rises by the ramp alone";
    EXPECT_LE(largest_step(bench.forces), ceiling::slew_n_per_s * tick_s + 1e-9) << period;
    const double least = glm::length(*std::ranges::min_element(bench.forces, {}, [](const Vec3& f) { return f.y; }));
    EXPECT_EQ(least > 2.9, period / 2 <= 20) << period;
  }
}

/// Good poses do not hide that every force is refused; forces that are taken between are none.
TEST(GivenForce, ADeviceThatRefusesEveryForceIsAFault) {
  for (const bool every : {true, false}) {
    LinkBench bench;
    const auto stylus = unthreaded(bench);
    push(bench, *stylus, 3, 0.5);
    for (int n = 0; n < 200; ++n) {
      bench.answer = every || n % 40 != 0 ? ForceAnswer::refused : ForceAnswer::taken;
      stylus->write_force(Vec3(0, 3, 0));
      stylus->service(tick_s);
      if (every && n * tick_s < ceiling::refusal_s - 2 * tick_s) {
        EXPECT_EQ(stylus->fault(), LinkFault::none);
      }
    }
    EXPECT_EQ(stylus->fault(), every ? LinkFault::forces_refused : LinkFault::none);
    EXPECT_EQ(stylus->on_device(), OnDevice::unknown);
    bench.answer = ForceAnswer::taken;
    push(bench, *stylus, 0, 0.01);
    EXPECT_EQ(stylus->on_device(), OnDevice::zero_taken);
  }
}

/// Good poses do not hide that no force can be sent. The longest pause of a link in lock-step is no fault: it waits for
/// an answer, and then for a lost one.
TEST(GivenForce, ADeviceThatTakesNoForceIsAFault) {
  const double pause_s = LockStepTimes{}.overdue + LockStep::longest_way;
  for (const double waits_s : {pause_s, ceiling::stall_s - 2 * tick_s, 0.2}) {
    LinkBench bench;
    const auto stylus = unthreaded(bench);
    push(bench, *stylus, 3, 0.5);
    bench.answer = ForceAnswer::waiting;
    push(bench, *stylus, 3, waits_s);
    const bool is_fault = waits_s > ceiling::stall_s;
    EXPECT_EQ(stylus->fault(), is_fault ? LinkFault::forces_refused : LinkFault::none) << waits_s;
    EXPECT_EQ(stylus->on_device(), OnDevice::pushing);
    bench.answer = ForceAnswer::taken;
    push(bench, *stylus, 3, 0.5);
    EXPECT_EQ(bench.force, is_fault ? Vec3(0) : Vec3(0, 3, 0)) << waits_s;
  }
}

/// What a guardian sees and hears: the last state, the word at the end.
struct HeardGuardian {
  TestFiles files;
  std::string told = files.write("told", "");
  GuardianSettings settings{
      .program = "/bin/sh", .kind = "-c", .address = "head -c1 > " + told + "; od -An -tu4 <&3 >> " + told + "; cat"};
  char word() const { return static_cast<char>(std::ifstream(told).get()); }
  OnDevice seen() const {
    char word = 0;
    unsigned count = 0, state = 9;
    std::ifstream(told) >> word >> count >> state;
    return static_cast<OnDevice>(state);
  }
};

enum class Loss { none, unplugged, unplugged_at_rest, silent, refused };

/// The guardian is dismissed only by a link whose device took a zero; in all other cases it sees that a force may lie
/// on the device, and goes on.
TEST(GivenForce, TheGuardianIsToldOfAForceThatMayLieOnALostDevice) {
  for (const Loss loss : {Loss::none, Loss::unplugged, Loss::unplugged_at_rest, Loss::silent, Loss::refused}) {
    HeardGuardian guardian;
    LinkBench bench;
    LinkStylusOptions options;
    options.start_guardian = [&](const GuardianSettings&) { return proved(start_guardian(guardian.settings)); };
    const auto stylus = unthreaded(bench, options);
    push(bench, *stylus, loss == Loss::unplugged_at_rest ? 0 : 3, 0.3);
    if (loss == Loss::unplugged || loss == Loss::unplugged_at_rest) bench.lost = true;
    if (loss == Loss::silent) bench.speaks = false;
    if (loss == Loss::refused) bench.answer = ForceAnswer::refused;
    for (int n = 0; n < 300; ++n) stylus->service(tick_s);
    const bool is_safe = loss == Loss::none || loss == Loss::unplugged_at_rest;
    EXPECT_EQ(stylus->on_device(), is_safe ? OnDevice::zero_taken : OnDevice::unknown);
    stylus->close();
    EXPECT_EQ(guardian.seen(), is_safe ? OnDevice::zero_taken : OnDevice::unknown);
    EXPECT_EQ(guardian.word(), is_safe ? 'q' : 'w');
  }
}

}  // namespace
}  // namespace palpate::device
