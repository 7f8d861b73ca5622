#pragma once

/// Where the servo leaves its frames, and the view, the charts and the recorder find them.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "plugin/session/broadcast_ring.h"
#include "plugin/session/tick_record.h"

namespace palpate::plugin {

class TickRing {
 public:
  /// 65 s of frames at 1 kHz, with four primitives in each: 30 MB. The recorder's backlog.
  static constexpr std::size_t default_frames = 1U << 16U;

  explicit TickRing(std::size_t frames = default_frames) : frames_(frames), shares_(4 * frames) {}

  /// Servo, wait-free.
  void push(const TickRecord& frame, std::span<const PrimitiveRecord> shares) noexcept;

  std::size_t capacity() const noexcept { return frames_.capacity(); }
  /// Frames ever written: the next one's number. (A session's frames are numbered in step.)
  std::uint64_t written() const noexcept { return frames_.written(); }
  std::uint64_t oldest() const noexcept { return frames_.oldest(); }

  /// Any thread: a frame, and its shares where they are asked for, appended. False where either was overwritten:
  /// nothing is appended then.
  bool read(std::uint64_t n, TickRecord& frame, std::vector<PrimitiveRecord>* shares = nullptr) const;

 private:
  struct Entry {
    TickRecord frame;
    std::uint64_t first_share = 0;
  };
  BroadcastRing<Entry> frames_;
  BroadcastRing<PrimitiveRecord> shares_;
};

}  // namespace palpate::plugin
