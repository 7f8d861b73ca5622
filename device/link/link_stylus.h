#pragma once

/// The stylus that every packet driver is: a thread of its own exchanges packets, and the servo tick only swaps values
/// with it, wait-free. The thread is also the first watchdog: a force that is not renewed becomes zero there.

#include <atomic>
#include <functional>
#include <memory>
#include <thread>

#include "device/link/latest.h"
#include "device/link/link.h"
#include "device/link/protocol.h"
#include "device/safety/guardian.h"
#include "device/stylus.h"

namespace palpate::device {

struct LinkStylusOptions {
  bool threaded = true;      ///< false: the owner of the stylus calls service()
  double force_age = 0.020;  ///< s: a force that write_force() does not renew becomes zero
  int priority = 60;         ///< SCHED_FIFO of the thread, above the servo's; where not allowed it goes without
  GuardianSettings guardian;
};

class LinkStylus final : public Stylus {
 public:
  /// Opens the device; throws std::runtime_error naming it and what to do.
  using LinkMaker = std::function<std::unique_ptr<Link>()>;

  LinkStylus(Specification specification, std::unique_ptr<Protocol> protocol, LinkMaker make_link,
             const LinkStylusOptions& options = {});
  ~LinkStylus() override;

  Specification specification() const override { return specification_; }
  void open() override;
  void close() noexcept override;
  Reading read() noexcept override;
  void write_force(const Vec3& force) noexcept override;
  State state() const noexcept override { return state_.load(std::memory_order_relaxed); }

  LinkFault fault() const noexcept { return fault_.load(std::memory_order_relaxed); }
  /// One exchange, waiting for packets at most `timeout` s. Only without a thread.
  void service(double timeout) noexcept;

 private:
  void exchange(double timeout, bool closing) noexcept;
  void judge_rate(double now) noexcept;
  void fail(LinkFault fault) noexcept;
  void send_zeros() noexcept;

  Specification specification_;
  std::unique_ptr<Protocol> protocol_;
  LinkMaker make_link_;
  LinkStylusOptions options_;
  std::unique_ptr<Link> link_;
  std::unique_ptr<Guardian> guardian_;
  std::thread thread_;
  std::atomic<bool> stop_{false};
  std::atomic<State> state_{State::disconnected};
  std::atomic<LinkFault> fault_{LinkFault::none};

  // Across the threads.
  Latest<Reading> reading_;
  Latest<Vec3> force_;
  // The exchanging thread's.
  double opened_ = 0;
  double force_time_ = 0;
  double news_time_ = 0;
  std::uint64_t news_ = 0;
  double window_start_ = 0;
  std::uint64_t window_news_ = 0;
  // The servo's.
  Reading last_reading_;
};

}  // namespace palpate::device
