#pragma once

/// Records a session while it runs: a separate thread takes the ticks from the ring and writes them. The servo never
/// waits for it. A slow disk loses no ticks until the ring is full (TickRing::default_ticks: 65 s at 1 kHz); ticks lost
/// after that are counted, and the loss is marked in the file. If the disk is full or gone, the recording ends but the
/// session goes on; what was flushed (once a second, and every 2048 ticks) stays readable.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "plugin/recording/recording_writer.h"
#include "plugin/session/tick_ring.h"
#include "solver/text/message.h"

namespace palpate::plugin {

struct RecorderOptions {
  std::uintmax_t spare_bytes = 64U << 20U;  ///< kept free on the disk: the recording ends before less is left
  std::optional<std::uint64_t> first_tick;  ///< of the ring; by default the next new one
  /// Ticks that the recording thread reaches later than this many ticks are recorded without KnownTo. Otherwise, after
  /// a slow write, fields would be computed at places far from the stylus.
  std::uint64_t most_behind = 250;
  /// Called by the recording thread before each batch is written. Tests use it to make a disk slow.
  std::function<void()> before_write;
  /// The clock for flushing. Tests set another one.
  std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;
};

/// The uncertainty of the position of the boundary that holds the proxy in a tick with these shares, mm
/// (Recording::known_to_mm); NaN if no boundary holds it. Called by the recording thread.
using KnownTo = std::function<double(const TickRecord& tick, std::span<const PrimitiveRecord> shares)>;

struct RecorderStatus {
  std::uint64_t written = 0;  ///< ticks
  std::uint64_t lost = 0;     ///< ticks
  bool stopped = false;       ///< before finish(): `why` gives the reason
  Text why;
};

class Recorder {
 public:
  /// Records all new ticks of the ring. The file is named `<file>.partial` until finish(). The ring must outlive the
  /// recorder. Throws std::runtime_error that names the file if it cannot be created.
  Recorder(const TickRing& ring, std::filesystem::path file, const RecordingHeader& header,
           RecorderOptions options = {});
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  /// As finish(), without reporting errors.
  ~Recorder();

  // Called by the controlling thread for each scene before it is published to the session.
  void note(const SceneRecord& scene, KnownTo known_to = {});
  void note(const StylusRecord& stylus);

  /// Ticks that are in the ring and not yet in the file.
  std::uint64_t backlog() const noexcept;
  /// The tick of the ring that will be written next.
  std::uint64_t next() const noexcept { return next_.load(std::memory_order_relaxed); }
  /// For a session that runs faster than the clock: waits until half of the ring is free.
  void wait_for_room();
  RecorderStatus status() const;

  /// Writes the rest of the ring and closes the file. Later ticks belong to the next recorder, whose
  /// RecorderOptions::first_tick is next(). To be called once.
  RecorderStatus finish();

 private:
  void run();
  bool write_batch();
  bool has_room() const;
  void write_ticks(std::uint64_t until);
  double known_to(const TickRecord& tick, std::span<const PrimitiveRecord> shares) const;
  void stop(const Text& why);

  const TickRing& ring_;
  RecorderOptions options_;
  std::filesystem::path file_;
  mutable std::mutex mutex_;  // protects the events, the status and the end; the servo never takes it
  std::condition_variable progress_;
  std::vector<std::function<void(RecordingWriter&)>> events_;
  RecorderStatus status_;
  bool ending_ = false;
  std::uint64_t end_ = std::numeric_limits<std::uint64_t>::max();  ///< later ticks belong to another recorder
  std::atomic<std::uint64_t> next_;                                // tick of the ring
  // Used by the recording thread.
  RecordingWriter writer_;
  std::vector<TickRecord> ticks_;
  std::vector<PrimitiveRecord> shares_;
  std::vector<double> known_to_mm_;
  std::map<std::uint32_t, KnownTo> known_to_;  // by the epoch of the scene
  std::thread thread_;
};

}  // namespace palpate::plugin
