#pragma once

/// An hour of probing in which everything happens again and again: scenes swapped every second, scans every minute, the
/// device unplugged at random; recorded in parts, each replayed while the next is felt. `palpate-bench soak`.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "plugin/recording/replay.h"

namespace palpate::plugin {

struct SoakOptions {
  double minutes = 60;          ///< of probing
  double seconds_of_scan = 60;  ///< two scans are a cycle
  double seconds_of_scene = 1;
  double seconds_between_unplugs = 20;  ///< mean
  bool at_clock_pace = false;           ///< on the servo thread; false: as fast as the arithmetic
  double rate_hz = 1000;
  std::uint64_t seed = 1;
  std::filesystem::path folder;  ///< for the parts of the recording, each removed once it was replayed
  std::function<void(double)> progress = [](double) {};
};

/// At the same point of each cycle: the last scan is gone, and the recording's part is closed.
struct SoakPoint {
  double time_s = 0;
  std::uint64_t live_bytes = 0;  ///< of the heap, all arenas
  std::uint64_t resident_bytes = 0;
};

struct SoakResult {
  std::uint64_t ticks = 0, missed = 0;
  std::uint64_t unaccounted = 0;  ///< deadlines that are neither a tick nor in a tick's `missed`
  std::uint64_t scenes = 0, scans = 0, unplugs = 0;
  std::uint64_t faulty_ticks = 0;  ///< with a latched fault
  std::uint64_t over_limit = 0;    ///< ticks that sent more than the limit, or changed it faster than the slew limit
  std::uint64_t not_finite = 0;
  std::uint64_t lost = 0;  ///< ticks that the recording did not get
  double largest_n = 0;
  Replay replay;
  std::vector<SoakPoint> points;
  /// Bytes by which the live heap differed between cycles, once warm: largest less smallest.
  std::uint64_t heap_spread() const;
  /// Of a line through the points, once warm: bytes an hour of probing.
  double resident_slope() const;
};

/// Throws std::runtime_error naming the file where the recording cannot be written.
SoakResult soak(const SoakOptions& options);

}  // namespace palpate::plugin
