#pragma once

/// A session as the panel runs it. Scan, scene and stylus may be set and removed in any order; each change takes effect
/// at once and is ramped. The servo runs while a stylus is held. All calls come from one thread, which also has to call
/// heartbeat().

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "device/stylus.h"
#include "io/volume.h"
#include "modes/scene/scene.h"
#include "plugin/recording/recorder.h"
#include "plugin/session/scan.h"
#include "plugin/session/servo.h"
#include "plugin/session/session.h"

namespace palpate::plugin {

/// How fast a change of scene takes effect.
enum class Pace {
  stepped,  ///< one step: takes the scene's whole ramp
  dragged   ///< one of many small steps of a drag: felt at once, because the drag itself is gradual
};

class LiveSession {
 public:
  LiveSession() = default;
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;
  /// As disconnect().
  ~LiveSession();

  /// Another scan, or another frame of it, raw or filtered ahead; null: none, and the stylus is disconnected. Throws
  /// std::invalid_argument where the scene cannot be felt on it.
  void set_scan(std::shared_ptr<const io::Volume> volume) { set_scan(std::move(volume), modes::Scene(scene_)); }
  /// The same with another scene, in one change. The scene is not felt before, on no scan.
  void set_scan(std::shared_ptr<const io::Volume> volume, const modes::Scene& scene);
  /// Throws std::invalid_argument, naming the key, for a scene that is not valid; the last one then goes on.
  void set_scene(const modes::Scene& scene, Pace pace = Pace::stepped);
  /// The scan as it was read.
  const std::shared_ptr<const io::Volume>& scan() const noexcept { return volume_; }
  /// The same as it is felt: through the scene's filter.
  const std::shared_ptr<const io::Volume>& felt_scan() const noexcept { return felt_.volume; }
  /// The scan through a filter that a scene is going to ask for: it then need not be computed in set_scene().
  void offer(std::shared_ptr<const io::Volume> filtered) { offered_ = std::move(filtered); }
  const modes::Scene& scene() const noexcept { return scene_; }
  /// Of the scene on the scan, for the stylus that is held or else for the simulated one; null without a scan.
  std::shared_ptr<const modes::Plan> plan() const noexcept { return felt_.plan; }
  /// Of the scene: TickRecord::scene_epoch of the frames that feel it.
  std::uint32_t epoch() const noexcept { return last_epoch_; }
  /// All that is felt.
  const PreparedScene& felt() const noexcept { return felt_; }
  /// N/m: what is felt, for a scene may ask for more than the stylus renders stably.
  double stiffness_n_per_m() const noexcept { return felt_.plan ? felt_.plan->stiffness_n_per_m : 0; }

  /// Whether forces are on from the first tick.
  enum class Start { released, feeling };
  /// Opens the stylus; where it starts feeling, the force is ramped up. Throws what Stylus::open() throws, and
  /// std::runtime_error without a scan.
  void connect(std::shared_ptr<device::Stylus> stylus, Start start = Start::feeling);
  /// The force falls to zero, then the stylus is closed and the recording ends, if there is one: its status is
  /// returned. Blocks for a tenth of a second.
  std::optional<RecorderStatus> disconnect() noexcept;
  bool is_connected() const noexcept { return servo_ != nullptr; }
  const device::Specification& specification() const noexcept { return specification_; }

  void feel() noexcept;     ///< the force comes up
  void release() noexcept;  ///< the force falls to zero, and stays there until feel()
  void clear_fault() noexcept;
  /// To be called at least every half second, or the servo takes the force away.
  void heartbeat();

  /// Frames of the session; null where none was begun yet. A new one with every connect().
  const TickRing* frames() const noexcept { return ring_.get(); }
  std::uint64_t missed() const noexcept { return servo_ ? servo_->missed() : 0; }
  const device::RealtimeStatus* realtime() const noexcept { return servo_ ? &servo_->realtime() : nullptr; }

  /// Begins to record. A recording can be repeated to the last bit from a session's first frame on: the session begins
  /// anew, its force ramped down and up. Throws std::runtime_error naming the file, or where no stylus is held.
  void record(const std::filesystem::path& file);
  /// Null status where nothing was recorded.
  std::optional<RecorderStatus> stop_recording();
  std::optional<RecorderStatus> recording() const;

 private:
  PreparedScene felt_of(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& volume) const;
  Prepared before() const { return {.felt = felt_, .scene = scene_}; }
  Snapshot snapshot(double change_s) const;
  SceneRecord record_of_scene(std::uint32_t epoch, double change_s) const;
  void publish(double change_s);
  void begin(std::shared_ptr<device::Stylus> stylus, const std::optional<std::filesystem::path>& file);
  std::optional<RecorderStatus> end() noexcept;

  const std::string& scan_hash() const;

  std::shared_ptr<const io::Volume> volume_;   // never filtered
  std::shared_ptr<const io::Volume> offered_;  // volume_ filtered, or null
  mutable std::string scan_hash_;              // of the volume; empty until asked for: it reads all voxels
  modes::Scene scene_;
  PreparedScene felt_;
  std::uint32_t last_epoch_ = 0;
  Start start_ = Start::feeling;  // as a session that begins now does: what was asked for last
  std::shared_ptr<device::Stylus> stylus_;
  device::Specification specification_;
  // In the order in which they lean on each other.
  std::unique_ptr<TickRing> ring_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<Servo> servo_;
};

}  // namespace palpate::plugin
