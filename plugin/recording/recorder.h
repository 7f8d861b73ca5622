#pragma once

/// Records a session while it runs: a thread of its own takes the frames from the ring and writes them. The servo never
/// waits for it. A disk that is slow costs nothing until the ring has gone round (TickRing::default_frames: 65 s at 1
/// kHz); what is lost beyond that is counted and marked in the file. A disk that is full, or gone, ends the recording
/// and not the session; what was flushed (once a second) stays readable.

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "plugin/recording/recording_writer.h"
#include "plugin/session/tick_ring.h"
#include "solver/text/message.h"

namespace palpate::plugin {

struct RecorderOptions {
  std::uintmax_t spare_bytes = 64U << 20U;   ///< room on the disk that is left to others: recording ends before that
  std::optional<std::uint64_t> first_frame;  ///< of the ring; by default the next that it gets
  /// Called by the recording thread before each batch is written; tests make a disk slow with it.
  std::function<void()> before_write;
};

struct RecorderStatus {
  std::uint64_t written = 0;  ///< frames
  std::uint64_t lost = 0;     ///< frames
  bool stopped = false;       ///< early: `why` says so for the user
  Text why;
};

class Recorder {
 public:
  /// Records what the ring gets from now on to the file, which is `<file>.partial` until finish(). The ring has to
  /// outlive the recorder. Throws std::runtime_error naming the file where it cannot be made.
  Recorder(const TickRing& ring, std::filesystem::path file, const RecordingHeader& header,
           RecorderOptions options = {});
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  /// As finish(), but silent.
  ~Recorder();

  // From the controlling thread: what the session was given, before it is published.
  void note(const SceneRecord& scene);
  void note(const StylusRecord& stylus);

  /// Frames that the ring holds and the file does not yet.
  std::uint64_t backlog() const noexcept;
  /// The frame of the ring that is to be written next.
  std::uint64_t next() const noexcept { return next_.load(std::memory_order_relaxed); }
  /// For a session that does not run at the clock's pace: waits until half of the ring is free.
  void wait_for_room();
  RecorderStatus status() const;

  /// Writes what is left in the ring and closes the file; frames that come meanwhile belong to the next recorder, whose
  /// RecorderOptions::first_frame is next(). Once.
  RecorderStatus finish();

 private:
  void run();
  bool write_batch();
  bool has_room() const;
  void write_frames(std::uint64_t until);
  void stop(const Text& why);

  const TickRing& ring_;
  RecorderOptions options_;
  std::filesystem::path file_;
  mutable std::mutex mutex_;  // of the events, the status and the end; never taken by the servo
  std::condition_variable progress_;
  std::vector<std::function<void(RecordingWriter&)>> events_;
  RecorderStatus status_;
  bool ending_ = false;
  std::uint64_t end_ = std::numeric_limits<std::uint64_t>::max();  ///< frames from here on are another recorder's
  std::atomic<std::uint64_t> next_;                                // frame of the ring
  // The recording thread's.
  RecordingWriter writer_;
  std::vector<TickRecord> frames_;
  std::vector<PrimitiveRecord> shares_;
  std::thread thread_;
};

}  // namespace palpate::plugin
