#pragma once

/// A session as the panel runs it. Scan, scene and stylus may be set and removed in any order; each change takes effect
/// at once and is ramped. The servo runs while a stylus is held. All calls come from one thread, which also has to call
/// heartbeat().

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "device/stylus.h"
#include "io/volume.h"
#include "modes/scene/scene.h"
#include "plugin/app/fault_report.h"
#include "plugin/app/running_session.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {

/// How fast a change of scene takes effect.
enum class Pace {
  stepped,  ///< one step: takes the scene's whole ramp
  dragged,  ///< one of many small steps of a drag: felt at once; a large step takes its part of the ramp
  at_once   ///< no force acts that could jump
};

class LiveSession {
 public:
  LiveSession() = default;
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;
  /// As disconnect().
  ~LiveSession();

  /// Another scan, or another frame of it, either raw or already filtered. Null: no scan, and the stylus is
  /// disconnected. Throws std::invalid_argument if the scene cannot be felt on it.
  void set_scan(std::shared_ptr<const io::Volume> volume) { set_scan(std::move(volume), modes::Scene(scene_)); }
  /// The same together with another scene, in one change. The scene is not felt on the previous scan. `frame`: which
  /// frame of its series the volume is, for recordings.
  void set_scan(std::shared_ptr<const io::Volume> volume, const modes::Scene& scene, const ScanFrame& frame = {});
  /// Throws std::invalid_argument that names the key if a scene is not valid; the previous scene then stays.
  void set_scene(const modes::Scene& scene, Pace pace = Pace::stepped);
  /// The scan without a filter.
  const std::shared_ptr<const io::Volume>& scan() const noexcept { return volume_; }
  /// The scan through the scene's filter, as it is felt.
  const std::shared_ptr<const io::Volume>& felt_scan() const noexcept { return felt_.volume; }
  /// Gives the scan through a filter that a scene is about to ask for, so that set_scene() need not compute it.
  void offer(std::shared_ptr<const io::Volume> filtered) { offered_ = {.volume = std::move(filtered)}; }
  /// The same for a scene that was prepared in another thread, so that set_scene(), or set_scan() with its volume,
  /// computes neither its filtered scan nor its structures again.
  void offer(PreparedScene ahead) { offered_ = std::move(ahead); }
  /// Whether everything that set_scene() needs of structures on this scan is in memory. For a scan other than scan():
  /// everything that set_scan() needs of structures and of the scene's filter. If not, these calls read files and
  /// compute fields, unless reading() did so before in another thread.
  bool has_read(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& scan) const;
  /// Work for another thread: reads what has_read() checks. Pass its result to offer(). Throws std::invalid_argument
  /// naming a structure that cannot be felt.
  std::function<PreparedScene()> reading(const modes::Scene& scene,
                                         const std::shared_ptr<const io::Volume>& scan) const;
  const modes::Scene& scene() const noexcept { return scene_; }
  /// The plan of the scene on the scan, for the connected stylus, or for the simulated one if none is connected. Null
  /// without a scan.
  std::shared_ptr<const modes::Plan> plan() const noexcept { return felt_.plan; }
  /// The number of the scene: TickRecord::scene_epoch of its ticks.
  std::uint32_t epoch() const noexcept { return last_epoch_; }
  /// The scene, scan and plan that are felt.
  const PreparedScene& felt() const noexcept { return felt_; }
  /// A sentence for each limit of the scene that is reduced for the connected stylus.
  std::vector<Text> drawn_down() const;
  /// N/m: the stiffness that is felt. A scene may ask for more than the stylus renders stably.
  double stiffness_n_per_m() const noexcept { return felt_.plan ? felt_.plan->stiffness_n_per_m : 0; }

  /// Sets a function that makes the servo's clock at each later connect(), for a given period (s). For tests only.
  using MakeClock = std::function<std::unique_ptr<ServoClock>(double period_s)>;
  void set_clock(MakeClock make) { make_clock_ = std::move(make); }

  /// Whether forces are on from the first tick.
  enum class Start { released, feeling };
  /// Opens the stylus. If it starts feeling, the force is ramped up. Throws what Stylus::open() throws, and
  /// std::runtime_error without a scan.
  void connect(std::shared_ptr<device::Stylus> stylus, Start start = Start::feeling);
  /// Lets the force fall to zero, closes the stylus and ends the recording, if there is one; returns its status. Blocks
  /// for a tenth of a second.
  std::optional<RecorderStatus> disconnect() noexcept;
  bool is_connected() const noexcept { return running_ && running_->servo() != nullptr; }
  const device::Specification& specification() const noexcept { return specification_; }
  /// The specification of the connected stylus, or of the simulated one if none is connected: scenes are planned for
  /// it.
  device::Specification planned_for() const;

  /// A problem with the stylus, in a sentence; empty if there is none (device::Stylus::trouble()).
  Text trouble() const { return stylus_ ? stylus_->trouble() : Text(); }

  /// As Stylus::allowed_force(); infinite without a stylus.
  double allowed_force_n() const noexcept;
  /// As Stylus::force_on_device(); none without a stylus.
  std::optional<device::ForceOnDevice> force_on_device() const noexcept {
    return stylus_ ? stylus_->force_on_device() : std::nullopt;
  }
  void feel() noexcept;     ///< ramps the force up
  void release() noexcept;  ///< lets the force fall to zero, where it stays until feel()
  /// The latest request, by feel(), release() or connect(). A cleared fault counts as release().
  Start start() const noexcept { return start_; }
  void clear_fault() noexcept;
  /// As Session::press(), until the session ends or restarts.
  void press(std::uint32_t buttons) noexcept;
  /// The orientation of the stylus, device frame. None if the stylus does not measure it, or if no stylus is connected.
  std::optional<glm::dquat> orientation() const noexcept;
  /// Opens the lost stylus again, without a force until feel(). The recording ends. Throws what Stylus::open() throws;
  /// the stylus is then disconnected.
  void reopen();
  /// The report of the session's last fault, whose file holds the second before it. None before the first fault.
  const std::optional<FaultReport>& last_fault() const noexcept { return last_fault_; }
  /// As Servo::heartbeat().
  void heartbeat();

  /// The ticks of the session; null if none has begun yet. Every connect() begins a new session.
  const TickRing* ticks() const noexcept { return running_ ? &running_->ring() : nullptr; }
  /// The same for readers in another thread: still readable after the session has ended.
  std::shared_ptr<const TickRing> shared_ticks() const noexcept { return running_ ? running_->shared_ring() : nullptr; }
  std::uint64_t missed() const noexcept { return is_connected() ? running_->servo()->missed() : 0; }
  const device::RealtimeStatus* realtime() const noexcept {
    return is_connected() ? &running_->servo()->realtime() : nullptr;
  }

  /// Starts to record. A recording can be replayed to the last bit only from the first tick of a session, so the
  /// session restarts, with the force ramped down and up. After a fault it starts without a force, until feel(). Throws
  /// std::runtime_error naming the file, or if no stylus is connected.
  void record(const std::filesystem::path& file);
  /// The status of the ended recording; none if nothing was recorded.
  std::optional<RecorderStatus> stop_recording();
  std::optional<RecorderStatus> recording() const;

 private:
  PreparedScene felt_of(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& volume) const;
  bool is_ahead_of(const std::shared_ptr<const io::Volume>& scan) const;
  std::vector<LoadedStructure> at_hand(const std::shared_ptr<const io::Volume>& scan) const;
  Prepared before() const { return {.felt = felt_, .scene = scene_, .read_ahead = {}}; }
  Snapshot snapshot(double change_s) const;
  double ramp_s() const;
  AsRecorded as_recorded(double change_s) const;
  void publish(double change_s);
  void begin(std::shared_ptr<device::Stylus> stylus, const std::optional<std::filesystem::path>& file);
  std::optional<RecorderStatus> end() noexcept;

  const std::string& scan_hash() const;

  std::shared_ptr<const io::Volume> volume_;  // never filtered
  PreparedScene offered_;                     // of the next scene, or its volume alone, or empty
  ScanFrame frame_;                           // of the volume in its series
  mutable std::string scan_hash_;             // of the volume; empty until asked for: it reads all voxels
  modes::Scene scene_;
  PreparedScene felt_;
  std::uint32_t last_epoch_ = 0;
  Start start_ = Start::feeling;  // the latest request, used by a session that starts now
  MakeClock make_clock_ = [](double period_s) { return std::make_unique<RealClock>(period_s); };
  std::shared_ptr<device::Stylus> stylus_;
  device::Specification specification_;
  std::optional<FaultReport> last_fault_;
  int faults_ = 0;                           // faults of the session that have been reported
  std::unique_ptr<RunningSession> running_;  // the latest one; its ring stays readable after its end
};

}  // namespace palpate::plugin
