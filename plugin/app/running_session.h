#pragma once

/// A running session, assembled in one place for `palpate probe`, the panel and the soak test: the opened stylus, the
/// ring of its ticks, the recording and the servo thread.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "device/stylus.h"
#include "io/volume.h"
#include "modes/scene/scene.h"
#include "plugin/recording/recorder.h"
#include "plugin/session/open_stylus.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/session/servo.h"
#include "plugin/session/session.h"
#include "plugin/structures/structure_files.h"

namespace palpate::plugin {

/// The snapshot of a scene on a scan for a stylus.
Snapshot snapshot_of(const modes::Scene& scene, const PreparedScene& felt, const device::Specification& stylus);
/// The snapshot of a recorded scene, on the scan that it was recorded on, with its structures from these files. Throws
/// std::invalid_argument if the scene is invalid, or if a structure is in none of the files.
Snapshot snapshot_of(const SceneRecord& record, const std::shared_ptr<const io::Volume>& volume, StructureFiles& files);
/// The same for a scene without structures, or with structures in this machine's files.
Snapshot snapshot_of(const SceneRecord& record, const std::shared_ptr<const io::Volume>& volume);

struct RecordedScene {
  SceneRecord record;
  KnownTo known_to;
};
/// Gives a snapshot in the form that recordings store, with its number (TickRecord::scene_epoch). Called only while
/// recording.
using AsRecorded = std::function<RecordedScene(std::uint32_t epoch)>;

struct RecordingTo {
  std::filesystem::path file;  ///< `<file>.partial` until the end
  RecordingHeader header;
  RecorderOptions options;
};

class RunningSession {
 public:
  struct Start {
    Snapshot snapshot;
    AsRecorded as_recorded;
    std::optional<RecordingTo> recording = {};  ///< from the first tick
    bool is_released = false;                   ///< without a force until Session::arm()
  };
  /// Throws as Recorder does. Ticks begin with start_servo(), or when the owner calls Session::tick().
  RunningSession(OpenStylus stylus, const Start& start);
  RunningSession(const RunningSession&) = delete;
  RunningSession& operator=(const RunningSession&) = delete;
  /// As end().
  ~RunningSession();

  const device::Specification& specification() const noexcept { return specification_; }
  const TickRing& ring() const noexcept { return *ring_; }
  /// The same for readers that outlive the session.
  std::shared_ptr<const TickRing> shared_ring() const noexcept { return ring_; }
  bool is_running() const noexcept { return session_ != nullptr; }
  /// Only while the session is running.
  Session& session() noexcept { return *session_; }
  /// Null if nothing is recorded.
  Recorder* recorder() noexcept { return recorder_.get(); }
  const Recorder* recorder() const noexcept { return recorder_.get(); }
  /// Null until start_servo().
  Servo* servo() noexcept { return servo_.get(); }
  const Servo* servo() const noexcept { return servo_.get(); }

  void start_servo();
  /// With another clock. For tests only.
  void start_servo(std::unique_ptr<ServoClock> clock, double period_s);

  /// The recording gets the scene before the servo can use it, so it has the scene of every tick.
  std::uint32_t publish(const Snapshot& next, const AsRecorded& as_recorded);
  /// As Session::change_stylus(); null: none. `specification`: of the new stylus.
  std::uint32_t change_stylus(std::shared_ptr<device::Stylus> stylus, const device::Specification& specification);

  /// The status of the ended recording; none if nothing was recorded.
  std::optional<RecorderStatus> stop_recording();
  /// After stop_recording(): continues in another file, with the first tick that is not in the previous file.
  void record_to(const RecordingTo& recording);

  /// Stops the servo and closes the stylus. The ring stays readable.
  void stop() noexcept;
  /// The same, and ends the recording.
  std::optional<RecorderStatus> end() noexcept;

 private:
  device::Specification specification_;
  std::uint32_t scenes_ = 0, styluses_ = 0;  // the latest numbers
  std::optional<std::uint64_t> next_tick_;   // the first one not yet in a recording
  // In order of dependence.
  std::shared_ptr<TickRing> ring_ = std::make_shared<TickRing>();
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<Servo> servo_;
};

}  // namespace palpate::plugin
