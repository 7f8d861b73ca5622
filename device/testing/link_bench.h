#pragma once

/// A LinkStylus whose device and time are set by the test.

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "device/link/link_stylus.h"
#include "device/vectors.h"

namespace palpate::device {

/// A device that answers at once and can be made to disappear; it outlives its driver.
struct LinkBench {
  std::atomic<double> time{0};
  std::atomic<bool> lost{false};
  std::atomic<int> takes{0};
  std::atomic<bool> speaks{true};  ///< sends poses
  std::uint64_t first_news = 0;    ///< poses received by the time it is connected
  State state = State::idle;
  LinkFault fault = LinkFault::none;  ///< reported by the device
  bool doubtful = false;
  double most_force = std::numeric_limits<double>::infinity();  ///< N: it takes no more, as on trial
  ForceAnswer answer = ForceAnswer::taken;
  Vec3 position{0};
  Vec3 force{0};             ///< N: on the device
  std::vector<Vec3> forces;  ///< all so far
  int flushes = 0;
  int open = 0;
};

class LinkBenchDriver final : public Driver {
 public:
  explicit LinkBenchDriver(LinkBench& bench) : bench_(bench) {}
  void connect() override {
    status_ = {.state = bench_.state};
    status_.news = bench_.first_news;
    ++bench_.open;
  }
  void disconnect() noexcept override { --bench_.open; }
  double now() noexcept override { return bench_.time; }
  void take(double timeout) noexcept override {
    ++bench_.takes;
    if (bench_.lost) return;  // a lost link returns at once
    bench_.time = bench_.time + timeout;
    status_.state = bench_.state;
    status_.fault = bench_.fault;
    status_.doubtful = bench_.doubtful;
    status_.most_force = bench_.most_force;
    if (!bench_.speaks) return;
    status_.position = bench_.position;
    ++status_.news;
  }
  ForceAnswer give(const Vec3& force) noexcept override {
    if (bench_.answer == ForceAnswer::waiting || bench_.answer == ForceAnswer::refused) return bench_.answer;
    bench_.force = bench_.answer == ForceAnswer::withheld ? Vec3(0) : clamp_length(force, bench_.most_force);
    bench_.forces.push_back(bench_.force);
    return bench_.answer;
  }
  void flush(double /*timeout*/) noexcept override { ++bench_.flushes; }
  bool lost() const noexcept override { return bench_.lost; }
  const ProtocolStatus& status() const noexcept override { return status_; }

 private:
  LinkBench& bench_;
  ProtocolStatus status_;
};

inline double asleep_s = 0;  ///< time that the machine has slept
inline double asleep() noexcept {
  return asleep_s;
}

inline Specification pushing() {
  Specification specification;
  specification.maximum_force = 8;
  specification.continuous_force = 4;
  return specification;
}

/// Makes another program count as a guardian: the test sends its proof.
inline std::unique_ptr<Guardian> proved(std::unique_ptr<Guardian> guardian) {
  auto& shared = const_cast<GuardianBeat&>(guardian->shared());
  shared.reach = GuardianReach::at_any_time;
  shared.proof = proof_for(shared.challenge);
  return guardian;
}

/// The test makes the exchanges itself.
inline std::unique_ptr<LinkStylus> unthreaded(LinkBench& bench, LinkStylusOptions options = {}) {
  options.threaded = false;
  options.asleep = &asleep;
  auto stylus = std::make_unique<LinkStylus>(pushing(), std::make_unique<LinkBenchDriver>(bench), options);
  stylus->open();
  return stylus;
}

/// Requests an upward force in each exchange. An exchange takes a millisecond.
inline void push(LinkBench& bench, LinkStylus& stylus, double newtons, double seconds) {
  const double end = bench.time + seconds;
  while (bench.time < end) {
    stylus.write_force(Vec3(0, newtons, 0));
    stylus.service(1e-3);
  }
}

}  // namespace palpate::device
