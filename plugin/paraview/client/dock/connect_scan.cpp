#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <vtkPVXMLElement.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxyLocator.h>
#include <vtkSMSourceProxy.h>

#include <QProgressBar>

#include <algorithm>
#include <optional>
#include <utility>

#include "plugin/app/open_scan.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/layout/host_layout.h"
#include "plugin/paraview/client/layout/volume_look_box.h"
#include "plugin/paraview/client/panel/curves_section.h"
#include "plugin/paraview/client/panel/profile_section.h"
#include "plugin/paraview/client/panel/recordings_section.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/paraview/client/panel/tissues_section.h"
#include "plugin/paraview/client/remote/server_series.h"
#include "plugin/paraview/client/scan/filter_row.h"
#include "plugin/paraview/client/scan/first_folder.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/stylus/mapping.h"
#include "plugin/paraview/client/views/color_maps.h"
#include "plugin/paraview/client/widgets/fold.h"
#include "plugin/paraview/client/words.h"

// A scan comes, its frame changes, it goes.

namespace palpate::plugin {

void PanelParts::connect_scan() {
  QObject::connect(&scans, &ScanModel::leaving, &dock, [this] {
    touching.release();  // before another scan takes its place
    leave_views();
  });
  QObject::connect(&scans, &ScanModel::out_of_reach, &dock, [this](const QString& why) { touching.set_no_scan(why); });
  QObject::connect(&scans, &ScanModel::scan_shown, &dock,
                   [this](const ScanHandle& handle, Brought brought) { show_scan(handle, brought); });
  QObject::connect(&scans, &ScanModel::frame_shown, &dock, [this](const ScanHandle& handle) { show_frame(handle); });
  QObject::connect(&servers, &ServerWatch::leaving, &dock, [this] { leave_server(); });
  QObject::connect(&servers, &ServerWatch::lost, &dock, [this] { leave(words(say("server-is-lost"))); });
  QObject::connect(pqApplicationCore::instance(), &pqApplicationCore::stateLoaded, &dock, [this] { adopt_state(); });
  open_first_folder(dock, [this](const std::string& folder) { scan->open(folder); });
}

void PanelParts::show_scan(const ScanHandle& handle, Brought brought) {
  if (!pqActiveObjects::instance().activeServer()) return;
  const bool restored = brought != Brought::by_opening && kept.is_open();
  touching.release();
  // Before the scene: what is chosen here is of the scan before.
  look_box->set_looks(readers.views().looks(), readers.views().first_look());
  if (!restored) {
    modes::Scene scene = scene_for(handle.scene, *handle.volume);
    scene.workspace.fit = true;
    touching.expect_scan();  // the scene is for this scan, not for the last one
    model.open(scene);
  }
  touching.set_scan(handle.volume, {.number = handle.frame, .count = handle.frames});
  if (brought != Brought::by_undo) model.forget_steps();
  tissues->forget_scan(handle);
  if (restored && brought == Brought::by_state) tissues->set_restored();
  show_marks(handle);
  open_views.set(readers.views().views());
  curves->profile().forget();
  read_opacity();
  flow.set_volume(handle.volume);
  filter->refresh();
  draw_contours();
  const bool felt = restored && kept.text(volume_look_key) == felt_look;
  if (felt) look_box->choose_felt();
  show_felt(felt);
  touching.begin_outside();
  show_structures(handle);
  note_scan(handle);
  scan_fold->set_open(false);
  layout->refresh_tabs();
  study(handle.volume);
  memory.give_back_soon();  // of what made way for it
}

void PanelParts::show_frame(const ScanHandle& handle) {
  touching.set_scan(handle.volume, {.number = handle.frame, .count = handle.frames});
  structures->set_frame(handle.volume);
  flow.set_volume(handle.volume);
  show_frame_values();
  draw_contours();
  note_scan(handle);
}

/// A frame may be a tenth as bright as the one before: windows and looks are its own, as far as nobody chose others.
void PanelParts::show_frame_values() {
  const auto look = static_cast<std::size_t>(std::max(look_box->currentIndex(), 0));
  const bool is_named = look_box->currentIndex() >= 0 && look < readers.views().looks().size();
  if (!readers.source()) return;
  readers.views().show_frame_values(*vtkSMSourceProxy::SafeDownCast(readers.source()->getProxy()));
  if (readers.views().looks().empty()) return;
  const std::optional<std::size_t> chosen =
      look_box->currentIndex() < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(look_box->currentIndex()));
  look_box->set_looks(readers.views().looks(), chosen);
  if (is_named) change_volume([&](vtkSMProxy& volume) { set_volume_look(volume, readers.views().looks().at(look)); });
}

void PanelParts::note_scan(const ScanHandle& handle) {
  const QString scan_words = size_in_words(*handle.volume);
  scan_fold->set_note(handle.frames > 1 ? QStringLiteral("%1, %2").arg(scan_words, handle.frame_in_words())
                                        : scan_words);
}

void PanelParts::study(const std::shared_ptr<const io::Volume>& volume) {
  studied = volume;
  studying->setValue(0);
  studying->show();
  studies.study(
      volume, [this](double done) { studying->setValue(static_cast<int>(100 * done)); },
      [this, unit = QString::fromStdString(volume->unit)](const auto& study, const std::string& error) {
        studying->hide();
        if (!study) {
          if (!error.empty()) emit model.refused(QString::fromStdString(error));
          return;
        }
        modes::Scene proposed = study->suggested;
        proposed.workspace = model.scene().workspace;
        tissues->set_proposed(proposed);
        curves->set_study(study, unit);
        touching.set_sites(study->sites);
        // What is felt or was edited already is not taken away from under the hand.
        if (model.is_edited() || touching.live().is_connected()) return;
        model.propose(proposed);
      });
}

/// What a state file has restored is taken over: scan, scene, marks and views, as if the program had begun with it.
void PanelParts::adopt_state() {
  touching.release();
  const auto sources = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>();
  pqPipelineSource* reader = nullptr;
  pqPipelineSource* scene = nullptr;
  for (pqPipelineSource* const source : sources) {
    const std::string kind = source->getProxy()->GetXMLName();
    if (kind == "PalpateDicomReader" && source != readers.source()) reader = source;
    if (kind == "PalpateScene" && source != kept.source()) scene = source;
  }
  if (!reader && !scene) return;
  if (reader) {
    leave_views();
    touching.expect_scan();
    marks.forget();
  }
  kept.replace(scene);
  if (reader) readers.restore(*reader, Brought::by_state);
}

/// In good order: another server, none, or a new session.
void PanelParts::leave_server() {
  const QString kept_in = ending ? QString() : recover();
  if (remote_server()) {
    const bool records = touching.live().recording().has_value();
    leave(records ? words(say("left-the-server-recording")) : words(say("left-the-server")));
  } else {
    const QString why = words(say("paraview-session-ended"));
    // With a stylus that is held the scan stays as it was felt, without a force, until another takes its place.
    touching.live().is_connected() ? touching.keep_off(why) : touching.set_no_scan(why);
    scans.lose_server();
  }
  if (!kept_in.isEmpty()) emit scans.told(kept_in, true);
}

/// All that a server has goes, and what is held of it is let go: first the force, and the recording with it.
void PanelParts::leave(const QString& why) {
  if (std::exchange(leaving, true)) return;  // what follows may ask the lost server, which tells that it is lost
  const bool held = touching.live().is_connected();
  touching.set_no_scan({});
  if (held) emit touching.told(why, true);  // before the views, which may find that their server does not answer
  scans.lose_server();
  leaving = false;
}

void PanelParts::leave_views() {
  studies.cancel();
  studying->hide();
  studied.reset();
  model.drop_waiting();
  filter->give_up();
  open_views.set({});
  flow.set_volume({});
  contours.set_felt({}, {}, {}, Pace::stepped);
  scan_fold->set_note({});
  memory.give_back_soon();
  leave_structures();
  leave_marks();
  curves->profile().forget();
}

}  // namespace palpate::plugin
