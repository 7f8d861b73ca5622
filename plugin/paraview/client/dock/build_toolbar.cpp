#include <pqActiveObjects.h>
#include <pqCoreUtilities.h>
#include <pqRenderView.h>

#include <QMainWindow>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/layout/clinical_toolbar.h"
#include "plugin/paraview/client/layout/help_menu.h"
#include "plugin/paraview/client/layout/host_layout.h"
#include "plugin/paraview/client/layout/view_picture.h"
#include "plugin/paraview/client/layout/volume_look_box.h"
#include "plugin/paraview/client/layout/window_box.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/stylus/stylus_section.h"
#include "plugin/paraview/client/views/enlarged_view.h"
#include "plugin/paraview/client/views/patient_volume.h"
#include "plugin/paraview/client/widgets/file_name.h"
#include "plugin/paraview/client/words.h"

// The clinical layout of ParaView's window, and the actions of its toolbar.

namespace palpate::plugin {

/// ParaView's window as a clinician's: one toolbar, the views, the panel.
void PanelParts::build_toolbar() {
  auto* const window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
  toolbar = new ClinicalToolbar(*new WindowBox(scans, readers.views(), window), looks.box(), window);
  window->addToolBar(Qt::TopToolBarArea, toolbar);
  layout = new HostLayout(*window, *toolbar, dock, &dock);
  add_help(*window);
  QObject::connect(toolbar, &ClinicalToolbar::folder_wanted, &dock,
                   [this](const QString& folder) { column->scan->open(folder.toStdString()); });
  QObject::connect(toolbar, &ClinicalToolbar::picture_wanted, &dock, [this] { ask_picture(); });
  QObject::connect(toolbar, &ClinicalToolbar::open_wanted, &dock, [this] { column->scan->ask_folder(); });
  QObject::connect(toolbar, &ClinicalToolbar::enlarged_wanted, &dock, [this](bool enlarged) { enlarge(enlarged); });
  QObject::connect(toolbar, &ClinicalToolbar::measure_wanted, &dock,
                   [this](Measure measure) { readers.views().set_measure(measure); });
  readers.views().set_measure_changed([this](Measure measure) { toolbar->show_measure(measure); });
  QObject::connect(toolbar, &ClinicalToolbar::cut_wanted, &dock, [this](bool cut) {
    if (PatientVolume* const patient = readers.views().patient()) patient->set_cut(cut);
  });
  QObject::connect(toolbar, &ClinicalToolbar::crop_wanted, &dock, [this](bool crop) {
    if (PatientVolume* const patient = readers.views().patient()) patient->set_cropped(crop);
  });
  readers.views().set_patient_changed([this] {
    const PatientVolume* const patient = readers.views().patient();
    toolbar->show_volume_cuts(patient && patient->can_cut(), patient && patient->can_crop());
  });
  QObject::connect(toolbar, &ClinicalToolbar::connect_wanted, column->stylus, &StylusSection::connect_or_not);
  QObject::connect(toolbar, &ClinicalToolbar::release_wanted, &dock, [this] { session.release(); });
  QObject::connect(toolbar, &ClinicalToolbar::advanced_wanted, layout, &HostLayout::set_advanced);
  QObject::connect(layout, &HostLayout::advanced_changed, toolbar, &ClinicalToolbar::show_advanced);
  QObject::connect(layout, &HostLayout::advanced_changed, &dock,
                   [this](bool advanced) { readers.set_advanced(advanced); });
  QObject::connect(column->stylus, &StylusSection::connection_shown, toolbar, &ClinicalToolbar::show_connection);
  readers.views().set_enlarged_changed([this](bool enlarged) { toolbar->show_enlarged(enlarged); });
}

void PanelParts::ask_picture() {
  auto* const marked = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  if (!marked) return;
  const QString file =
      ask_file_to_write(&dock, tr("Save a picture of the views"), tr("Pictures (*.png)"), QStringLiteral("png"));
  if (file.isEmpty()) return;
  if (!save_picture(*marked, file)) {
    tell_not_written(&dock, tr("Save a picture of the views"),
                     words(say("panel-cannot-write", file.toStdString(),
                               tr("the folder does not exist, or you may not write to it").toStdString())));
  }
}

void PanelParts::enlarge(bool enlarged) {
  auto* const marked = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  if (marked) set_enlarged(*marked, enlarged);
}

}  // namespace palpate::plugin
