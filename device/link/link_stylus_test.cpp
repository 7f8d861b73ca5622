#include "device/link/link_stylus.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

namespace palpate::device {
namespace {

/// A device that answers at once and can be told to go; it outlives its driver.
struct Bench {
  std::atomic<double> time{0};
  std::atomic<bool> lost{false};
  std::atomic<int> takes{0};
  Vec3 force{0};
};

class BenchDriver final : public Driver {
 public:
  explicit BenchDriver(Bench& bench) : bench_(bench) {}
  void connect() override { status_.state = State::idle; }
  void disconnect() noexcept override {}
  double now() noexcept override { return bench_.time; }
  void take(double timeout) noexcept override {
    ++bench_.takes;
    if (bench_.lost) return;  // as a link does that is gone: at once
    bench_.time = bench_.time + timeout;
    ++status_.news;
  }
  void give(const Vec3& force) noexcept override { bench_.force = force; }
  void flush(double /*timeout*/) noexcept override {}
  bool lost() const noexcept override { return bench_.lost; }
  const ProtocolStatus& status() const noexcept override { return status_; }

 private:
  Bench& bench_;
  ProtocolStatus status_;
};

double asleep_s = 0;
double asleep() noexcept {
  return asleep_s;
}

Specification pushing() {
  Specification specification;
  specification.maximum_force = 8;
  specification.continuous_force = 4;
  return specification;
}

std::unique_ptr<LinkStylus> unthreaded(Bench& bench) {
  LinkStylusOptions options;
  options.threaded = false;
  options.asleep = &asleep;
  auto stylus = std::make_unique<LinkStylus>(pushing(), std::make_unique<BenchDriver>(bench), options);
  stylus->open();
  return stylus;
}

void push(Bench& bench, LinkStylus& stylus, double newtons, double seconds) {
  const double end = bench.time + seconds;
  while (bench.time < end) {
    stylus.write_force(Vec3(0, newtons, 0));
    stylus.service(1e-3);
  }
}

TEST(LinkStylus, AThreadWhoseDeviceIsGoneDoesNotSpin) {
  Bench bench;
  LinkStylus stylus(pushing(), std::make_unique<BenchDriver>(bench));
  stylus.open();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  bench.lost = true;
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(stylus.fault(), LinkFault::unplugged);
  const int before = bench.takes;
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_LT(bench.takes - before, 100) << "more than once a millisecond";
}

TEST(LinkStylus, NothingIsPushedAgainAfterTheMachineSlept) {
  Bench bench;
  const auto stylus = unthreaded(bench);
  push(bench, *stylus, 1, 0.1);
  ASSERT_EQ(bench.force, Vec3(0, 1, 0));
  asleep_s += 30;
  push(bench, *stylus, 1, 0.1);
  EXPECT_EQ(bench.force, Vec3(0));
  EXPECT_EQ(stylus->fault(), LinkFault::slept);
  EXPECT_EQ(stylus->state(), State::fault);
}

TEST(LinkStylus, NothingIsPushedAgainAfterTheProgramWasStopped) {
  Bench bench;
  const auto stylus = unthreaded(bench);
  push(bench, *stylus, 1, 0.1);
  bench.time = bench.time + 5;
  push(bench, *stylus, 1, 0.1);
  EXPECT_EQ(bench.force, Vec3(0));
  EXPECT_EQ(stylus->fault(), LinkFault::held_up);
}

TEST(LinkStylus, GivesForLongNoMoreThanTheContinuousForce) {
  Bench bench;
  const auto stylus = unthreaded(bench);
  push(bench, *stylus, 8, 2.5);
  EXPECT_DOUBLE_EQ(bench.force.y, 8);
  push(bench, *stylus, 8, 20);
  EXPECT_NEAR(bench.force.y, 4, 0.05);
  push(bench, *stylus, 3, 1);
  EXPECT_DOUBLE_EQ(bench.force.y, 3);
}

}  // namespace
}  // namespace palpate::device
