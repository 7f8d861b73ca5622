#pragma once

/// Runs the haptic session for the panel while a stylus is held, and emits polled() thirty times a second.

#include <QObject>
#include <QString>
#include <QTimer>

#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "modes/scene/site_map.h"
#include "modes/scene/workspace.h"
#include "plugin/app/live_session.h"
#include "plugin/app/stylus_choice.h"
#include "plugin/paraview/client/model/mark_button.h"
#include "plugin/paraview/client/model/mouse_hand.h"
#include "plugin/paraview/client/model/new_ticks.h"
#include "plugin/paraview/client/model/scene_model.h"
#include "plugin/paraview/client/model/scene_reader.h"
#include "plugin/paraview/client/model/slow_work.h"
#include "plugin/recording/marks.h"
#include "plugin/report/nearest_structure.h"
#include "plugin/session/felt_workspace.h"

namespace palpate::plugin {

/// What was felt since the last poll, and the last tick.
struct SessionStatus {
  bool connected = false;
  bool replayed = false;  ///< of a recording: nothing is felt
  bool fresh = false;     ///< whether there is a tick
  TickRecord tick;
  std::vector<PrimitiveRecord> shares;
  modes::Workspace workspace;           ///< of the tick
  glm::dvec3 probe_mm{0}, proxy_mm{0};  ///< patient space
  std::string tissue;
  std::string held;                         ///< the boundary that holds the proxy, in words; empty if none does
  std::optional<NearestStructure> nearest;  ///< of the structures that the scene reads
  double force_n = 0;         ///< on the device, which may be another than the tick's; the last one known of a lost one
  bool is_warm = false;       ///< the motors' heat limits the force
  bool is_held_back = false;  ///< the device gets less than the tick's force, for another reason than heat
  bool may_push = false;      ///< the stylus is lost, and it is not known that its force has ended
  double peak_n = 0;          ///< the largest since the last poll
  double tick_us = 0;         ///< median since the last poll
  std::uint64_t missed = 0;   ///< since the stylus was connected
  bool clutched = false;
  bool feels = false;                         ///< forces were turned on, and not turned off since
  QString kept_off;                           ///< why the force is held back; empty: it is not
  std::shared_ptr<const modes::Scene> scene;  ///< the felt scene; null: the panel's

  std::optional<glm::dquat>
      orientation;  ///< of the stylus in the patient, if the device reports it: its z along the handle
  QString homing;   ///< how the stylus is homed
  QString trouble;  ///< what is wrong with it, and what to do; empty: nothing
  QString held_up;  ///< why the panel stopped answering, as far as known: "drawing took 2.3 s"

  bool is_seen() const { return fresh && (connected || replayed); }
};

class SessionController : public QObject {
  Q_OBJECT

 public:
  explicit SessionController(SceneModel& model, QObject* parent = nullptr);
  ~SessionController() override;

  /// Another scan, or another frame of it, with the model's scene. The force is ramped across the change. For a scan
  /// announced by expect_scan(), and for one without the scene's filter, slow parts (structures of the scene, its
  /// filter) are prepared in the background; until they are ready, expects_scan() is true, there is no force, and the
  /// previous scan stays.
  void set_scan(std::shared_ptr<const io::Volume> volume, const ScanFrame& frame);
  /// Passes on the scan through the filter of a scene that is about to be set.
  void offer(std::shared_ptr<const io::Volume> filtered) { live_.offer(std::move(filtered)); }
  void offer(const PreparedScene& ahead) { live_.offer(ahead); }
  /// Where each boundary lies in the scan, once known; used to name the boundary that holds the stylus.
  void set_sites(std::shared_ptr<const modes::SiteMap> sites) { sites_ = std::move(sites); }
  /// Records work of the panel's thread that has just ended, such as "drawing". If the force is removed because the
  /// panel did not answer, the message names this work.
  void note_work(const QString& what, double seconds) { slow_.note(what, seconds); }
  /// Until the next set_scan(), scenes are checked only for validity, because they are meant for the coming scan.
  void expect_scan() { coming_.expected = true; }
  bool expects_scan() const { return coming_.expected; }
  /// There is no scan that can be felt: releases the stylus. connect() is refused with `why`, if it is given.
  void set_no_scan(const QString& why);
  const QString& why_no_scan() const { return why_no_scan_; }
  const LiveSession& live() const { return live_; }
  /// The most recent status.
  const SessionStatus& last() const { return status_; }

  /// As LiveSession::set_clock(). Virtual, so that the tests' plug-in, which is not linked with this one, can call it.
  virtual void set_clock(LiveSession::MakeClock make) { live_.set_clock(std::move(make)); }
  /// `start` returns where a simulated stylus begins. It is called when the scene is planned.
  void set_start(std::function<glm::dvec3(const device::Specification&)> start) { start_ = std::move(start); }
  /// Without a force: only feel() turns it on.
  void connect_stylus(const StylusChoice& choice);
  void disconnect_stylus();
  /// Another scan is in the views: moves a simulated stylus to its starting place there, as soon as the scan is felt.
  void begin_outside();
  void feel();
  void release();
  /// Removes the force and refuses feel(), until called with an empty reason.
  void keep_off(const QString& why);
  /// Clears a fault; there is still no force. A lost stylus is opened again.
  void clear_fault();
  /// The record of the session's last fault, as a sentence; empty: none.
  QString last_fault() const;
  void record(const std::string& file);
  void stop_recording();

  /// Presses and releases the mark button, like the stylus' own button. Does nothing without a stylus.
  void press_mark();
  void let_go_mark() { mark_button_.let_go(); }
  /// The mark that a press at the last tick would make.
  FeltMark mark_here() const;

  /// Separates the hand from the patient: there is no force, and on unclutching the stylus is at the same place in the
  /// patient as before, however the hand has moved meanwhile. `rotation`: the device's axes in the patient from then
  /// on.
  void clutch();
  void unclutch(const glm::dmat3& rotation);
  bool is_clutched() const { return parted_.has_value(); }
  /// Whether the mapping may change: not while forces are on, because the change moves the stylus through the patient.
  bool may_remap() const;

  /// Gives the status while no stylus is connected.
  void show_instead(std::function<SessionStatus()> status) { instead_ = std::move(status); }

  // The hand of the simulated stylus, for mouse and keyboard.
  bool has_simulated() const { return hand_.holds() && live_.is_connected(); }
  void move_hand(const glm::dvec3& patient_mm) { hand_.move(patient_mm, workspace_.now()); }
  /// The target of the hand, mm, patient space: its last position, or else that of the stylus.
  glm::dvec3 hand_mm() const { return hand_.place_mm().value_or(status_.probe_mm); }
  /// Lets the simulated hand relax until no force acts on it.
  void let_go() { hand_.let_go(); }
  /// True: the mouse is used for something else and does not move the stylus.
  void keep_mouse_off(bool off) { hand_.keep_mouse_off(off); }
  bool takes_mouse() const { return hand_.takes_mouse() && live_.is_connected(); }

 signals:
  /// The stylus' clutch button was released. The stylus views unclutch, because they know their rotation.
  void clutch_button_let_go();
  void polled(const palpate::plugin::SessionStatus& status);
  void connection_changed();
  /// Another scan, another frame of it, or none is felt from now on.
  void felt_scan_changed();
  void told(const QString& message, bool problem);
  /// The result of a press of the mark button, without a name.
  void marked(const palpate::plugin::MarkMade& made);
  /// A recording has been written completely.
  void recorded(const QString& file);

 private:
  /// Whether the user has turned forces on. The session stores that; a fault turns them off until it is cleared.
  bool feels() const;
  void tell_recorded(const std::optional<RecorderStatus>& status);
  void take_scan(std::shared_ptr<const io::Volume> volume, const ScanFrame& frame);
  /// Whether a scan waits for files that are being read for it; take_scan() follows.
  bool is_read_for(const std::shared_ptr<const io::Volume>& volume, const ScanFrame& frame);
  QString why_kept_off() const;
  /// The session has begun anew, on the same stylus.
  void begin_anew();
  /// The mapping that puts the hand's present position at the place in the patient where the stylus stayed.
  modes::WorkspaceSettings joined(const glm::dmat3& rotation) const;
  void commit(const modes::Scene& scene, Pace pace);
  void follow_workspace();
  void poll();
  /// What lies on the device, of the status' last tick.
  void tell_force();
  /// The buttons pressed and released since the last poll.
  void obey_buttons(std::uint32_t pressed, std::uint32_t let, bool releases);
  void follow_marks();

  SceneModel& model_;
  LiveSession live_;
  QString why_no_scan_;
  QString homing_;
  MouseHand hand_;
  FeltWorkspace workspace_;
  NewTicks ticks_;
  MarkButton mark_button_{live_};
  /// Hand and patient are separated by the clutch.
  struct Parted {
    glm::dvec3 at_mm{0};  ///< where the stylus stays in the patient
    bool felt = false;    ///< forces return when it ends
    bool ends = false;    ///< as soon as the scene has the new mapping
  };
  std::optional<Parted> parted_;
  QString kept_off_;
  std::function<glm::dvec3(const device::Specification&)> start_;
  SessionStatus status_;
  std::shared_ptr<const modes::SiteMap> sites_;
  SlowWork slow_;
  std::function<SessionStatus()> instead_;
  QString recording_to_;
  QTimer heart_, polls_;
  SceneReader reader_{live_};  // its thread must end before the session; coming_.reader's, too
  struct ComingScan {
    bool expected = false;
    bool begins_outside = false;  ///< move the simulated stylus to its starting place when the scan is felt
    SceneReader reader;           ///< reads the files for it
  };
  ComingScan coming_{.reader = SceneReader(live_)};
};

}  // namespace palpate::plugin
