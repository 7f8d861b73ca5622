#pragma once

/// An hour of probing with repeated changes and faults: new scenes every second, new scans every minute, the device
/// unplugged at random. The session is recorded in parts; each is replayed while the next is recorded. `palpate-bench
/// soak`.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "plugin/recording/replay.h"

namespace palpate::plugin {

struct SoakOptions {
  double minutes = 60;          ///< of probing
  double seconds_of_scan = 60;  ///< a cycle is two scans
  double seconds_of_scene = 1;
  double seconds_between_unplugs = 20;  ///< mean
  bool at_clock_pace = false;           ///< on the servo thread; false: as fast as possible
  double rate_hz = 1000;
  std::uint64_t seed = 1;
  std::filesystem::path folder;  ///< for the parts of the recording; each is deleted after its replay
  std::function<void(double)> progress = [](double) {};
};

/// The state at the same point of each cycle: the last scan is closed, and the recording's part is complete.
struct SoakPoint {
  double time_s = 0;
  std::uint64_t live_bytes = 0;  ///< of the heap, all arenas
  std::uint64_t resident_bytes = 0;
};

struct SoakResult {
  std::uint64_t ticks = 0, missed = 0;
  std::uint64_t unaccounted = 0;  ///< deadlines that are neither a tick nor counted in a tick's `missed`
  std::uint64_t scenes = 0, scans = 0, unplugs = 0;
  std::uint64_t faulty_ticks = 0;  ///< with a fault latched
  std::uint64_t over_limit = 0;    ///< ticks that sent more than the force limit, or exceeded the slew limit
  std::uint64_t not_finite = 0;
  std::uint64_t lost = 0;  ///< ticks missing from the recording
  double largest_n = 0;
  Replay replay;
  std::vector<SoakPoint> points;
  /// Largest less smallest live heap of the cycles, bytes, after warming up.
  std::uint64_t heap_spread() const;
  /// Slope of a line through the points after warming up: bytes per hour of probing.
  double resident_slope() const;
};

/// Throws std::runtime_error naming the file if the recording cannot be written.
SoakResult soak(const SoakOptions& options);

}  // namespace palpate::plugin
