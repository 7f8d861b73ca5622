#pragma once

/// The ring in which the servo leaves its tick records for the view, the charts and the recorder.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "plugin/session/broadcast_ring.h"
#include "plugin/session/tick_record.h"

namespace palpate::plugin {

class TickRing {
 public:
  /// 65 s of ticks at 1 kHz, with four primitives in each: 30 MB. The recorder may be this far behind.
  static constexpr std::size_t default_ticks = 1U << 16U;

  explicit TickRing(std::size_t ticks = default_ticks) : ticks_(ticks), shares_(4 * ticks) {}

  /// Servo, wait-free.
  void push(const TickRecord& tick, std::span<const PrimitiveRecord> shares) noexcept;

  std::size_t capacity() const noexcept { return ticks_.capacity(); }
  /// The number of ticks written so far, which is the next tick's number. (A session counts its ticks in the same way.)
  std::uint64_t written() const noexcept { return ticks_.written(); }
  std::uint64_t oldest() const noexcept { return ticks_.oldest(); }

  /// Any thread: a tick. If `shares` are asked for, its shares are appended. False if either was overwritten; nothing
  /// is appended then.
  bool read(std::uint64_t n, TickRecord& tick, std::vector<PrimitiveRecord>* shares = nullptr) const;

 private:
  struct Entry {
    TickRecord tick;
    std::uint64_t first_share = 0;
  };
  BroadcastRing<Entry> ticks_;
  BroadcastRing<PrimitiveRecord> shares_;
};

}  // namespace palpate::plugin
