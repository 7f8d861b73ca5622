#include "device/safety/fault_log.h"

#include <algorithm>

namespace palpate::device {

void FaultLog::record(const SafetyInput& input, const SafetyResult& result) noexcept {
  if (stopped()) return;
  ring_[count_ % capacity] = {input, result};
  ++count_;
  const bool faulty = result.fault != Fault::none;
  was_clear_ = was_clear_ || !faulty;
  const bool has_enough = faulty && was_clear_ && after_fault_++ == ticks_after_fault;
  if (has_enough || (!faulty && after_fault_ > 0)) stopped_.store(true, std::memory_order_release);
}

std::vector<SafetyTick> FaultLog::ticks() const {
  const std::size_t kept = std::min(count_, capacity);
  std::vector<SafetyTick> ticks;
  ticks.reserve(kept);
  for (std::size_t i = count_ - kept; i < count_; ++i) ticks.push_back(ring_[i % capacity]);
  return ticks;
}

void FaultLog::clear() noexcept {
  count_ = 0;
  after_fault_ = 0;
  was_clear_ = false;
  stopped_.store(false, std::memory_order_release);
}

}  // namespace palpate::device
