#include "plugin/paraview/client/dock/column.h"

#include <QCheckBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QVBoxLayout>

#include "plugin/paraview/client/panel/curves_section.h"
#include "plugin/paraview/client/panel/footer.h"
#include "plugin/paraview/client/panel/marks_section.h"
#include "plugin/paraview/client/panel/modes_section.h"
#include "plugin/paraview/client/panel/profile_section.h"
#include "plugin/paraview/client/panel/recordings_section.h"
#include "plugin/paraview/client/panel/sharing_section.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/paraview/client/panel/tissue_study.h"
#include "plugin/paraview/client/panel/tissues_section.h"
#include "plugin/paraview/client/scan/filter_row.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/widgets/column_scroll.h"
#include "plugin/paraview/client/widgets/fold.h"

namespace palpate::plugin {

Column::Column(const Follows& models, const std::function<Eye()>& eye) : strokes_(models.session) {
  auto* const content = new QWidget(this);
  auto* const column = new QVBoxLayout(content);
  column->setContentsMargins(6, 2, 6, 2);
  column->setSpacing(4);
  build_scan(models, *column);
  fold(tr("Tissues"), QStringLiteral("palpateTissuesSection"), build_tissues(models), true, *column);
  build_others(models, eye, *column);
  auto* const about = new QLabel(
      tr("Palpate %1. Research software, not a medical device.").arg(QStringLiteral(PALPATE_VERSION)), content);
  about->setObjectName(QStringLiteral("palpateAbout"));
  about->setWordWrap(true);
  column->addWidget(about);
  column->addStretch(1);

  auto* const halves = new QVBoxLayout(this);
  halves->setContentsMargins(0, 0, 0, 0);
  halves->setSpacing(0);
  halves->addWidget(new ColumnScroll(QStringLiteral("palpateScroll"), content, this), 1);
  halves->addWidget(footer = new Footer(models.session, models.scene, this));
  connect(footer, &Footer::technical_changed, this, &Column::show_technical);
  show_technical(footer->is_technical());
}

/// The sections first: they run what strokes_ makes.
Column::~Column() {
  qDeleteAll(findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly));
}

Fold* Column::fold(const QString& title, const QString& name, QWidget* section, bool open, QVBoxLayout& column) {
  auto* const made = new Fold(title, name, section, open, column.parentWidget());
  column.addWidget(made);
  return made;
}

void Column::build_scan(const Follows& models, QVBoxLayout& column) {
  scan = new ScanSection(models.scans);
  connect(scan, &ScanSection::ras_wanted, this, &Column::ras_wanted);
  filter = new FilterRow(models.scene, models.session, models.scans, models.readers, scan);
  scan->layout()->addWidget(filter);
  scan_fold = fold(tr("Scan"), QStringLiteral("palpateScanSection"), scan, true, column);
  column.addWidget(&scan->notes());
}

QWidget* Column::build_tissues(const Follows& models) {
  auto* const box = new QWidget;
  auto* const column = new QVBoxLayout(box);
  column->setContentsMargins(0, 0, 0, 0);
  tissues = new TissuesSection(models.scene, box);
  column->addWidget(tissues);
  study = new TissueStudy(models.scene, models.session, box);
  connect(study, &TissueStudy::studied, this,
          [this](const auto& found, const QString& unit) { curves->set_study(found, unit); });
  connect(study, &TissueStudy::proposed, tissues, &TissuesSection::set_proposed);
  column->addWidget(study);
  auto* const drawn = new QCheckBox(tr("Boundaries on the slices"), box);
  drawn->setObjectName(QStringLiteral("palpateContours"));
  drawn->setToolTip(tr("Draws a line where each boundary is felt, in its color. The lines follow each edit."));
  drawn->setChecked(true);
  connect(drawn, &QCheckBox::toggled, this, &Column::boundaries_wanted);
  auto* const crossed = new QCheckBox(tr("Crosshair"), box);
  crossed->setObjectName(QStringLiteral("palpateCrosshair"));
  crossed->setToolTip(tr("Shows where the other two slices lie. Hold Shift to make them follow the pointer."));
  connect(crossed, &QCheckBox::toggled, this, &Column::crosshair_wanted);
  auto* const shown_lines = new QHBoxLayout;
  shown_lines->addWidget(drawn, 1);
  shown_lines->addWidget(crossed);
  column->addLayout(shown_lines);
  return box;
}

void Column::build_others(const Follows& models, const std::function<Eye()>& eye, QVBoxLayout& column) {
  structures = new StructuresSection(models.views, models.scene, models.session, models.correction);
  auto* const structures_fold =
      fold(tr("Structures"), QStringLiteral("palpateStructuresSection"), structures, false, column);
  connect(structures, &StructuresSection::listed, this,
          [this, structures_fold] { structures_fold->set_note(structures->in_words()); });
  stylus = new StylusSection(models.session, models.scene, eye);
  fold(tr("Stylus"), QStringLiteral("palpateStylusSection"), stylus, true, column);
  marks = new MarksSection(models.marks, models.session);
  marks_fold = fold(tr("Marks"), QStringLiteral("palpateMarksSection"), marks, false, column);
  curves = new CurvesSection(models.scene, models.session, strokes_);
  fold(tr("Transfer function"), QStringLiteral("palpateCurvesSection"), curves, false, column);
  modes = new ModesSection(models.scene, models.session);
  fold(tr("Modes"), QStringLiteral("palpateModesSection"), modes, false, column);
  profile = new ProfileSection(models.views, models.session, models.scene, strokes_);
  fold(tr("Force profile"), QStringLiteral("palpateProfileSection"), profile, false, column);
  recordings = new RecordingsSection(models.views, models.session);
  recordings_fold = fold(tr("Recordings"), QStringLiteral("palpateRecordingsSection"), recordings, false, column);
  auto* const shared = new SharingSection(models.sharing);
  auto* const shared_fold = fold(tr("3D Slicer"), QStringLiteral("palpateSharingSection"), shared, false, column);
  connect(&models.sharing, &SharingModel::changed, shared_fold,
          [shared, shared_fold] { shared_fold->set_note(shared->in_words()); });
}

void Column::show_technical(bool shown) {
  modes->show_technical(shown);
  stylus->show_technical(shown);
}

}  // namespace palpate::plugin
