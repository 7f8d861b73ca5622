#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <vtkPVXMLElement.h>
#include <vtkSMProxyLocator.h>

#include "plugin/app/open_scan.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/layout/host_layout.h"
#include "plugin/paraview/client/panel/curves_section.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/paraview/client/panel/tissue_study.h"
#include "plugin/paraview/client/panel/tissues_section.h"
#include "plugin/paraview/client/remote/server_series.h"
#include "plugin/paraview/client/scan/filter_row.h"
#include "plugin/paraview/client/scan/first_folder.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/widgets/fold.h"
#include "plugin/paraview/client/words.h"

// Connections for opening a scan, changing its frame, and closing it.

namespace palpate::plugin {

void PanelParts::connect_scan() {
  QObject::connect(&scans, &ScanModel::leaving, &dock, [this] {
    session.release();  // before another scan takes its place
    leave_views();
  });
  QObject::connect(&scans, &ScanModel::out_of_reach, &dock, [this](const QString& why) { session.set_no_scan(why); });
  QObject::connect(&scans, &ScanModel::scan_shown, &dock,
                   [this](const ScanHandle& handle, Brought brought) { show_scan(handle, brought); });
  QObject::connect(&scans, &ScanModel::frame_shown, &dock, [this](const ScanHandle& handle) { show_frame(handle); });
  QObject::connect(&servers, &ServerWatch::leaving, &dock, [this] { leave_server(); });
  QObject::connect(&servers, &ServerWatch::lost, &dock, [this] { leave(words(say("server-is-lost"))); });
  QObject::connect(pqApplicationCore::instance(), &pqApplicationCore::stateLoaded, &dock, [this] { adopt_state(); });
  QObject::connect(column->scan, &ScanSection::fetch_offered, &dock, [this] {
    column->scan_fold->set_open(true);
    column->scan->show_archive();
  });
  open_first_folder(dock, [this](const std::string& folder) { column->scan->open(folder); });
}

void PanelParts::show_scan(const ScanHandle& handle, Brought brought) {
  if (!pqActiveObjects::instance().activeServer()) return;
  const bool restored = brought != Brought::by_opening && kept.is_open();
  session.release();
  // Before the scene: the present choice belongs to the previous scan.
  looks.begin_scan();
  if (!restored) {
    modes::Scene scene = scene_for(handle.scene, *handle.volume);
    scene.workspace.fit = true;
    session.expect_scan();  // the scene is for this scan, not for the last one
    model.open(scene);
  }
  session.set_scan(handle.volume, {.number = handle.frame, .count = handle.frames});
  if (brought != Brought::by_undo) model.forget_steps();
  column->tissues->forget_scan(handle);
  if (restored && brought == Brought::by_state) column->tissues->set_restored();
  show_marks(handle);
  open_views.set(readers.views().views());
  column->curves->profile().forget();
  looks.read_opacity();
  layers.flow.set_volume(handle.volume);
  column->filter->refresh();
  layers.draw_boundaries();
  looks.restore(restored);
  session.begin_outside();
  show_structures(handle);
  note_scan(handle);
  column->scan_fold->set_open(column->scan->offers_fetched());
  layout->refresh_tabs();
  column->study->study(handle.volume);
  layers.memory.give_back_soon();  // of what made way for it
}

void PanelParts::show_frame(const ScanHandle& handle) {
  session.set_scan(handle.volume, {.number = handle.frame, .count = handle.frames});
  column->structures->set_frame(handle.volume);
  layers.flow.set_volume(handle.volume);
  looks.show_frame_values();
  layers.draw_boundaries();
  column->study->study_frame(handle.volume);
  note_scan(handle);
}

void PanelParts::note_scan(const ScanHandle& handle) {
  const QString scan_words = size_in_words(*handle.volume);
  column->scan_fold->set_note(handle.frames > 1 ? QStringLiteral("%1, %2").arg(scan_words, handle.frame_in_words())
                                                : scan_words);
}

/// Takes over what a state file has restored: scan, scene, marks and views, as if the program had begun with it.
void PanelParts::adopt_state() {
  session.release();
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
    session.expect_scan();
    marks.forget();
  }
  kept.replace(scene);
  if (!reader) return;  // marks of the scan may be kept now that are not in the file
  unsaved.note_state_saved();
  readers.restore(*reader, Brought::by_state);
}

/// In good order: another server, none, or a new session.
void PanelParts::leave_server() {
  const QString kept_in = guard.recover();
  if (remote_server()) {
    const bool records = session.live().recording().has_value();
    leave(records ? words(say("left-the-server-recording")) : words(say("left-the-server")));
  } else {
    const QString why = words(say("paraview-session-ended"));
    // With a stylus that is held the scan stays as it was felt, without a force, until another takes its place.
    session.live().is_connected() ? session.keep_off(why) : session.set_no_scan(why);
    scans.lose_server();
  }
  if (!kept_in.isEmpty()) emit scans.told(kept_in, true);
}

/// Releases everything of a server: first the force, and with it the recording.
void PanelParts::leave(const QString& why) {
  if (layers.is_paused()) return;  // what follows may ask the lost server, which tells that it is lost
  layers.pause(true);
  const bool held = session.live().is_connected();
  session.set_no_scan({});
  if (held) emit session.told(why, true);  // before the views, which may find that their server does not answer
  scans.lose_server();
  layers.pause(false);
}

void PanelParts::leave_views() {
  model.drop_waiting();
  column->study->cancel();  // what has changed is not studied
  column->filter->give_up();
  open_views.set({});
  layers.forget_scan();
  column->scan_fold->set_note({});
  leave_structures();
  leave_marks();
  column->curves->set_study(nullptr, {});
  column->curves->profile().forget();
}

}  // namespace palpate::plugin
