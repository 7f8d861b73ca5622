#include <QCheckBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QVBoxLayout>

#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/panel/curves_section.h"
#include "plugin/paraview/client/panel/footer.h"
#include "plugin/paraview/client/panel/marks_section.h"
#include "plugin/paraview/client/panel/modes_section.h"
#include "plugin/paraview/client/panel/profile_section.h"
#include "plugin/paraview/client/panel/recordings_section.h"
#include "plugin/paraview/client/panel/sharing_section.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/paraview/client/panel/tissues_section.h"
#include "plugin/paraview/client/scan/filter_row.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/stylus/stylus_section.h"
#include "plugin/paraview/client/widgets/column_scroll.h"
#include "plugin/paraview/client/widgets/fold.h"

// The panel's sections, from top to bottom, and the footer below them.

namespace palpate::plugin {

/// Sections first: what connects them finds all of them.
void PanelParts::build() {
  readers.follow(scans);
  build_column();
  build_toolbar();
  connect_start();
  connect_scan();
  connect_structures();
  connect_correction();
  connect_marks();
  connect_scene();
  connect_session();
  connect_unsaved();
}

void PanelParts::build_column() {
  auto* const content = new QWidget(&dock);
  auto* const column = new QVBoxLayout(content);
  column->setContentsMargins(6, 2, 6, 2);
  column->setSpacing(4);
  scan = new ScanSection(scans);
  QObject::connect(scan, &ScanSection::ras_wanted, &dock,
                   [this](bool on) { readers.views().set_coordinates(on ? Coordinates::ras : Coordinates::letters); });
  filter = new FilterRow(model, touching, scans, readers, scan);
  scan->layout()->addWidget(filter);
  scan_fold = new Fold(tr("Scan"), QStringLiteral("palpateScanSection"), scan, true, content);
  column->addWidget(scan_fold);
  column->addWidget(&scan->notes());
  column->addWidget(new Fold(tr("Tissues"), QStringLiteral("palpateTissuesSection"), build_tissues(), true, content));
  structures = new StructuresSection(open_views, model, touching, correction);
  structures_fold = new Fold(tr("Structures"), QStringLiteral("palpateStructuresSection"), structures, false, content);
  column->addWidget(structures_fold);
  stylus = new StylusSection(touching, model, [this] { return views.eye(); });
  column->addWidget(new Fold(tr("Stylus"), QStringLiteral("palpateStylusSection"), stylus, true, content));
  marks_list = new MarksSection(marks, touching);
  marks_fold = new Fold(tr("Marks"), QStringLiteral("palpateMarksSection"), marks_list, false, content);
  column->addWidget(marks_fold);
  curves = new CurvesSection(model, touching, strokes);
  column->addWidget(new Fold(tr("Transfer function"), QStringLiteral("palpateCurvesSection"), curves, false, content));
  modes = new ModesSection(model, touching);
  column->addWidget(new Fold(tr("Modes"), QStringLiteral("palpateModesSection"), modes, false, content));
  profile = new ProfileSection(open_views, touching, model, strokes);
  column->addWidget(new Fold(tr("Force profile"), QStringLiteral("palpateProfileSection"), profile, false, content));
  recordings = new RecordingsSection(open_views, touching);
  recordings_fold = new Fold(tr("Recordings"), QStringLiteral("palpateRecordingsSection"), recordings, false, content);
  column->addWidget(recordings_fold);
  auto* const shared = new SharingSection(sharing);
  auto* const shared_fold = new Fold(tr("3D Slicer"), QStringLiteral("palpateSharingSection"), shared, false, content);
  column->addWidget(shared_fold);
  QObject::connect(&sharing, &SharingModel::changed, shared_fold,
                   [shared, shared_fold] { shared_fold->set_note(shared->in_words()); });
  auto* const about = new QLabel(
      tr("Palpate %1. Research software, not a medical device.").arg(QStringLiteral(PALPATE_VERSION)), content);
  about->setObjectName(QStringLiteral("palpateAbout"));
  about->setWordWrap(true);
  about->setEnabled(false);
  column->addWidget(about);
  column->addStretch(1);

  auto* const whole = new QWidget(&dock);
  auto* const halves = new QVBoxLayout(whole);
  halves->setContentsMargins(0, 0, 0, 0);
  halves->setSpacing(0);
  halves->addWidget(new ColumnScroll(QStringLiteral("palpateScroll"), content, whole), 1);
  halves->addWidget(footer = new Footer(touching, model, whole));
  dock.setWidget(whole);
}

QWidget* PanelParts::build_tissues() {
  auto* const box = new QWidget;
  auto* const column = new QVBoxLayout(box);
  column->setContentsMargins(0, 0, 0, 0);
  tissues = new TissuesSection(model, box);
  column->addWidget(tissues);
  studying = new QProgressBar(box);
  studying->setObjectName(QStringLiteral("palpateStudying"));
  studying->setFormat(tr("Looking for tissues %p%"));
  studying->hide();
  column->addWidget(studying);
  auto* const drawn = new QCheckBox(tr("Boundaries on the slices"), box);
  drawn->setObjectName(QStringLiteral("palpateContours"));
  drawn->setToolTip(tr("Draws a line where each boundary is felt, in its color. The lines follow each edit."));
  drawn->setChecked(true);
  QObject::connect(drawn, &QCheckBox::toggled, &dock, [this](bool on) { contours.set_visible(on); });
  auto* const crossed = new QCheckBox(tr("Crosshair"), box);
  crossed->setObjectName(QStringLiteral("palpateCrosshair"));
  crossed->setToolTip(tr("Shows where the other two slices lie. Hold Shift, and they follow the pointer."));
  QObject::connect(crossed, &QCheckBox::toggled, &dock, [this](bool on) { crosshair.set_visible(on); });
  auto* const shown_lines = new QHBoxLayout;
  shown_lines->addWidget(drawn, 1);
  shown_lines->addWidget(crossed);
  column->addLayout(shown_lines);
  return box;
}

}  // namespace palpate::plugin
