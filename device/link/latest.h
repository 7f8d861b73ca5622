#pragma once

/// The newest value handed from one thread to another, wait-free on both sides: a triple buffer.

#include <array>
#include <atomic>
#include <cstdint>

namespace palpate::device {

/// One thread writes and one reads. Values that are not read in time are dropped; the newest one is always whole.
template <typename T>
class Latest {
 public:
  explicit Latest(const T& initial = T{}) { slots_.fill(initial); }

  void store(const T& value) noexcept {
    slots_[write_] = value;
    write_ = shared_.exchange(write_ | fresh, std::memory_order_acq_rel) & index;
  }

  /// The newest value stored, or the previous one again if there is none.
  const T& load() noexcept {
    if (shared_.load(std::memory_order_relaxed) & fresh) {
      read_ = shared_.exchange(read_, std::memory_order_acq_rel) & index;
    }
    return slots_[read_];
  }

  /// Reading thread only: whether load() would return a value that it has not returned before.
  bool has_news() const noexcept { return (shared_.load(std::memory_order_relaxed) & fresh) != 0; }

 private:
  static constexpr unsigned fresh = 4;
  static constexpr unsigned index = 3;

  std::array<T, 3> slots_;
  alignas(64) unsigned write_ = 0;
  alignas(64) unsigned read_ = 1;
  alignas(64) std::atomic<unsigned> shared_{2};
};

}  // namespace palpate::device
