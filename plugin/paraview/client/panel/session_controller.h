#pragma once

/// The panel's session: runs while a stylus is held, and tells thirty times a second what is felt.

#include <QObject>
#include <QString>
#include <QTimer>

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/simulated/simulated_stylus.h"
#include "modes/scene/workspace.h"
#include "plugin/app/live_session.h"
#include "plugin/app/stylus_choice.h"
#include "plugin/paraview/client/panel/scene_model.h"
#include "plugin/report/nearest_structure.h"

namespace palpate::plugin {

/// What has been felt since the last look, and the last frame.
struct SessionStatus {
  bool connected = false;
  bool replayed = false;  ///< of a recording: nothing is felt
  bool fresh = false;     ///< whether there is a frame
  TickRecord frame;
  std::vector<PrimitiveRecord> shares;
  modes::Workspace workspace;           ///< of the frame
  glm::dvec3 probe_mm{0}, proxy_mm{0};  ///< patient space
  std::string tissue;
  std::string held;                         ///< the boundary that holds the proxy, in words; empty where none does
  std::optional<NearestStructure> nearest;  ///< of the structures that the scene reads
  double force_n = 0;                       ///< that the device was fed, in the last frame
  double peak_n = 0;                        ///< the largest since the last look
  double tick_us = 0;                       ///< median since the last look
  std::uint64_t missed = 0;                 ///< since the stylus was connected
  bool clutched = false;
  bool feels = false;  ///< forces were asked for, and have not been taken away since
  QString kept_off;    ///< why there is no force until that has gone; empty: nothing keeps it away
  std::shared_ptr<const modes::Scene> scene;  ///< that was felt; null: the panel's

  bool is_seen() const { return fresh && (connected || replayed); }
};

class SessionController : public QObject {
  Q_OBJECT

 public:
  explicit SessionController(SceneModel& model, QObject* parent = nullptr);
  ~SessionController() override;

  /// Another scan, or another frame of it, with the scene that the model has. The force is ramped over.
  void set_scan(std::shared_ptr<const io::Volume> volume);
  /// The scan through the filter that a scene to come has.
  void offer(std::shared_ptr<const io::Volume> filtered) { live_.offer(std::move(filtered)); }
  /// Until the next set_scan() a scene only has to be valid: it is meant for the scan to come.
  void expect_scan() { expects_scan_ = true; }
  /// There is none to be felt, and the stylus is let go; connecting is refused with `why`, where that is said.
  void set_no_scan(const QString& why);
  const QString& why_no_scan() const { return why_no_scan_; }
  const LiveSession& live() const { return live_; }
  /// What was seen last.
  const SessionStatus& last() const { return look_; }

  /// Where a simulated stylus begins: asked once the scene is planned.
  void set_start(std::function<glm::dvec3(const device::Specification&)> start) { start_ = std::move(start); }
  /// Without a force: only feel() turns it on.
  void connect_stylus(const StylusChoice& choice);
  void disconnect_stylus();
  /// Another scan is in the views: a simulated stylus goes where it would begin there.
  void begin_outside();
  void feel();
  void release();
  /// The force is taken away, and feel() refused, until this is called with an empty reason.
  void keep_off(const QString& why);
  /// Leaves the stylus without a force.
  void clear_fault();
  void record(const std::string& file);
  void stop_recording();

  /// The hand and the patient part: no force, and on unclutching the stylus is where it was in the patient, however the
  /// hand has moved meanwhile. `rotation`: the device's axes in the patient from then on.
  void clutch();
  void unclutch(const glm::dmat3& rotation);
  bool is_clutched() const { return clutched_; }
  /// Whether the mapping may change: a hand that feels something would be thrown.
  bool may_remap() const;

  /// What is looked at while no stylus is held.
  void show_instead(std::function<SessionStatus()> look) { instead_ = std::move(look); }

  // The simulated stylus' hand, for mouse and keyboard.
  bool has_simulated() const { return simulated_ != nullptr && live_.is_connected(); }
  void move_hand(const glm::dvec3& patient_mm);
  /// Where the hand wants to be, mm, patient space: where it was put last, or where the stylus is.
  glm::dvec3 hand_mm() const { return hand_mm_.value_or(look_.probe_mm); }
  /// The simulated hand relaxes until nothing pushes it.
  void let_go();
  /// While the mouse means something else, it does not take the stylus.
  void keep_mouse_off(bool off) { mouse_off_ = off; }
  bool takes_mouse() const { return has_simulated() && !mouse_off_; }

 signals:
  /// The stylus' clutch button was let go: the stylus views, which know how they are turned, unclutch.
  void clutch_button_let_go();
  void looked(const palpate::plugin::SessionStatus& look);
  void connection_changed();
  void told(const QString& message, bool problem);
  /// A recording has been written, whole.
  void recorded(const QString& file);

 private:
  void give_way();
  void tell_recorded(const std::optional<RecorderStatus>& status);
  void commit(const modes::Scene& scene, Pace pace);
  void follow_workspace();
  void look();
  void obey_buttons(std::uint32_t buttons);

  SceneModel& model_;
  LiveSession live_;
  QString why_no_scan_;
  std::shared_ptr<device::SimulatedStylus> simulated_;
  modes::Workspace before_, now_;  // of the last two scenes
  std::uint64_t next_frame_ = 0;
  std::uint32_t buttons_ = 0;
  std::optional<glm::dvec3> hand_mm_;  // while the workspace stays and it does not relax
  bool letting_go_ = false;
  bool clutched_ = false;
  bool feels_ = false;
  bool feels_after_clutch_ = false;
  bool expects_scan_ = false;
  QString kept_off_;
  std::function<glm::dvec3(const device::Specification&)> start_;
  bool mouse_off_ = false;
  glm::dvec3 clutched_at_mm_{0};
  SessionStatus look_;
  std::function<SessionStatus()> instead_;
  QString recording_to_;
  QTimer heart_, looks_;
};

}  // namespace palpate::plugin
