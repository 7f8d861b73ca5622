#include "plugin/bench/tick_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>
#include <utility>

#include "device/link/realtime.h"

namespace palpate::plugin {
namespace {

/// Where the poses say, there and back again. Costs as good as nothing to read and write.
class WalkingStylus final : public device::Stylus {
 public:
  explicit WalkingStylus(std::span<const glm::dvec3> poses_m) : poses_(poses_m) {}
  device::Specification specification() const override { return {.name = "walk", .maximum_force = 10}; }
  void open() override { state_ = device::State::idle; }
  void close() noexcept override { state_ = device::State::disconnected; }
  device::Reading read() noexcept override {
    const std::size_t turn = 2 * poses_.size();
    const std::size_t at = tick_ % turn;
    return {.time = 1e-3 * static_cast<double>(tick_),
            .position = poses_[at < poses_.size() ? at : turn - 1 - at],
            .fresh = true};
  }
  void write_force(const device::Vec3& force) noexcept override {
    force_ = force;
    ++tick_;
  }
  device::State state() const noexcept override { return state_; }

 private:
  std::span<const glm::dvec3> poses_;
  std::size_t tick_ = 0;
  device::Vec3 force_{0};
  device::State state_ = device::State::disconnected;
};

}  // namespace

void run_as_servo(const std::function<void()>& work) {
  std::thread([&] {
    device::make_thread_realtime(50);
    work();
  }).join();
}

void pause_now_and_then(std::size_t tick) {
  if (tick % 20 == 19) {
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

TickRow measure_ticks(const std::string& what, const Snapshot& snapshot, std::span<const glm::dvec3> poses_m,
                      std::size_t ticks, double rate_hz, Between between) {
  TickRing ring(1024);
  Session session(snapshot, std::make_shared<WalkingStylus>(poses_m), &ring);
  TickRow row{.what = what, .ticks = ticks};
  std::vector<double> us(ticks);
  const double us_per_count = 1e-3 / modes::counts_per_ns();
  std::array<std::uint64_t, stage_count> stages{};
  std::uint64_t primitives = 0, bricks = 0, sub_steps = 0;
  const auto tick = [&](std::size_t n) {
    const std::uint64_t begun = modes::clock_count();
    const TickRecord& record = session.tick();
    us[n] = static_cast<double>(modes::clock_count() - begun) * us_per_count;
    for (std::size_t stage = 0; stage < stage_count; ++stage) stages[stage] += record.stage_ns[stage];
    primitives += record.share_count;
    bricks += record.from_brick;
    sub_steps += record.sub_steps;
  };
  run_as_servo([&] {
    device::Metronome metronome(rate_hz > 0 ? 1 / rate_hz : 1e-3);
    auto awake_until = std::chrono::steady_clock::now();
    const auto pause = [&](std::size_t n) {
      if (rate_hz <= 0) return pause_now_and_then(n);
      if (between == Between::asleep) return void(metronome.wait());
      awake_until += std::chrono::nanoseconds(std::llround(1e9 / rate_hz));
      while (std::chrono::steady_clock::now() < awake_until) {
      }
    };
    for (std::size_t n = 0; n < ticks / 10; ++n) {
      session.tick();
      pause(n);
    }
    for (std::size_t n = 0; n < ticks; ++n) {
      tick(n);
      pause(n);
    }
  });
  const auto mean = [&](std::uint64_t sum) { return static_cast<double>(sum) / static_cast<double>(ticks); };
  for (std::size_t stage = 0; stage < stage_count; ++stage) row.stage_mean_ns[stage] = mean(stages[stage]);
  row.us = percentiles_of(std::move(us));
  row.primitives = mean(primitives);
  row.sub_steps = mean(sub_steps);
  row.from_brick = mean(bricks);
  return row;
}

struct BusyThread::Work {
  std::atomic<bool> stop{false};
  std::vector<std::uint64_t> memory =
      std::vector<std::uint64_t>(std::size_t{8} << 20U, 1);  // 64 MiB: beyond the caches
  std::thread thread{[this] {
    std::uint64_t sum = 0;
    while (!stop.load(std::memory_order_relaxed)) {
      for (std::size_t i = 0; i < memory.size() && !stop.load(std::memory_order_relaxed); i += 8) {
        sum += memory[i]++;
      }
    }
    memory[0] = sum;
  }};
};

BusyThread::BusyThread() : work_(std::make_unique<Work>()) {}

BusyThread::~BusyThread() {
  work_->stop = true;
  work_->thread.join();
}

std::string tick_row_header() {
  std::string header = fmt::format("{:<38} {:>7} {:>7} {:>7} {:>8}  {:>5} {:>5} {:>6} ", "us", "p50", "p99", "p99.9",
                                   "largest", "prim.", "sub", "brick");
  for (const char* stage : stage_names) header += fmt::format(" {:>7}", stage);
  return header + "   (stages: mean ns)";
}

std::string to_text(const TickRow& row) {
  std::string text =
      fmt::format("{:<38} {:>7.2f} {:>7.2f} {:>7.2f} {:>8.1f}  {:>5.2f} {:>5.2f} {:>5.0f}% ", row.what, row.us.median,
                  row.us.p99, row.us.p999, row.us.largest, row.primitives, row.sub_steps, 100 * row.from_brick);
  for (const double stage : row.stage_mean_ns) text += fmt::format(" {:>7.0f}", stage);
  return text;
}

std::string tick_csv_header() {
  std::string header = "what,ticks,p50_us,p99_us,p999_us,largest_us,primitives,sub_steps,from_brick";
  for (const char* stage : stage_names) header += fmt::format(",{}_mean_ns", stage);
  return header + "\n";
}

std::string to_csv(const TickRow& row) {
  std::string line = fmt::format("\"{}\",{},{},{},{},{},{},{},{}", row.what, row.ticks, row.us.median, row.us.p99,
                                 row.us.p999, row.us.largest, row.primitives, row.sub_steps, row.from_brick);
  for (const double stage : row.stage_mean_ns) line += fmt::format(",{}", stage);
  return line + "\n";
}

}  // namespace palpate::plugin
