#include "device/safety/fault_log.h"

#include <algorithm>

namespace palpate::device {

void FaultLog::record(const SafetyInput& input, const SafetyResult& result) noexcept {
  if (stopped_.load(std::memory_order_relaxed)) return;
  ring_[count_ % capacity] = {input, result};
  ++count_;
  if (result.fault != Fault::none && after_fault_++ == frames_after_fault) {
    stopped_.store(true, std::memory_order_release);
  }
}

std::vector<SafetyFrame> FaultLog::frames() const {
  const std::size_t kept = std::min(count_, capacity);
  std::vector<SafetyFrame> frames;
  frames.reserve(kept);
  for (std::size_t i = count_ - kept; i < count_; ++i) frames.push_back(ring_[i % capacity]);
  return frames;
}

void FaultLog::clear() noexcept {
  count_ = 0;
  after_fault_ = 0;
  stopped_.store(false, std::memory_order_release);
}

}  // namespace palpate::device
