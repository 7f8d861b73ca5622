#pragma once

/// A ring buffer with one writer and any number of readers, each at its own pace. No thread waits for another. A reader
/// that was overtaken gets an error, and never a half-written item.

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <type_traits>

namespace palpate::plugin {

/// Items are copied through atomic words (a seqlock whose payload is atomic): Boehm, "Can seqlocks get along with
/// programming language memory models?", 2012.
template <typename T>
class BroadcastRing {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 8 == 0);
  static constexpr std::size_t words = sizeof(T) / 8;
  using Slot = std::array<std::atomic<std::uint64_t>, words>;

 public:
  /// Holds the last `capacity` items. The capacity is rounded up to a power of two.
  explicit BroadcastRing(std::size_t capacity)
      : capacity_(std::bit_ceil(capacity)), slots_(std::make_unique<Slot[]>(capacity_)) {}

  /// Writer, wait-free.
  void push(const T& item) noexcept {
    const std::uint64_t n = written_.load(std::memory_order_relaxed);
    begun_.store(n + 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    std::array<std::uint64_t, words> bits;
    std::memcpy(bits.data(), &item, sizeof(T));
    Slot& slot = slots_[n & (capacity_ - 1)];
    for (std::size_t i = 0; auto& word : slot) word.store(bits[i++], std::memory_order_relaxed);
    written_.store(n + 1, std::memory_order_release);
  }

  std::size_t capacity() const noexcept { return capacity_; }
  /// The number of items written so far, which is also the number of the next one.
  std::uint64_t written() const noexcept { return written_.load(std::memory_order_acquire); }
  /// The number of the oldest item that may still be in the ring.
  std::uint64_t oldest() const noexcept {
    const std::uint64_t n = written();
    return n > capacity_ ? n - capacity_ : 0;
  }

  /// Any thread: item number n, which must be below written(). False if it has been overwritten.
  bool read(std::uint64_t n, T& item) const noexcept {
    std::array<std::uint64_t, words> bits;
    const Slot& slot = slots_[n & (capacity_ - 1)];
    for (std::size_t i = 0; const auto& word : slot) bits[i++] = word.load(std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_acquire);
    if (begun_.load(std::memory_order_relaxed) > n + capacity_) return false;
    std::memcpy(static_cast<void*>(&item), bits.data(), sizeof(T));
    return true;
  }

 private:
  std::size_t capacity_;
  std::unique_ptr<Slot[]> slots_;
  alignas(64) std::atomic<std::uint64_t> begun_{0};
  alignas(64) std::atomic<std::uint64_t> written_{0};
};

}  // namespace palpate::plugin
