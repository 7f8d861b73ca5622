#include <QDoubleSpinBox>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QMimeData>
#include <QPointer>
#include <QSlider>
#include <QToolButton>
#include <QUrl>
#include <QVBoxLayout>

#include <algorithm>

#include "plugin/paraview/client/model/shown_mode.h"
#include "plugin/paraview/client/panel/correct_box.h"
#include "plugin/paraview/client/panel/outline_out.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/paraview/client/widgets/color_dialog.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/widgets/row_list.h"
#include "plugin/paraview/client/widgets/tool_button.h"
#include "plugin/paraview/client/words/mode_words.h"
#include "plugin/structures/drawn_structure.h"
#include "plugin/structures/study_structures.h"

// The section's widgets, from top to bottom, with the actions of its buttons, menus and dialogs.

namespace palpate::plugin {
namespace {

constexpr double first_margin_mm = 3, first_opacity = 0.4;

QString widget_text(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

}  // namespace

void StructuresSection::build() {
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(3);
  list_ = make_row_list(*this, "palpateStructureList", 0, 120);
  list_->setToolTip(tr("Check the box to show it in the views. A double click chooses its color."));
  connect(list_, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item) {
    if (listing_) return;
    entries_[static_cast<std::size_t>(list_->indexOfTopLevelItem(item))].shown = item->checkState(0) == Qt::Checked;
    draw();
    make_next();
  });
  connect(list_, &QTreeWidget::currentItemChanged, this, [this] { list(); });
  connect(list_, &QTreeWidget::itemDoubleClicked, this,
          [this](QTreeWidgetItem* item) { choose_color(static_cast<std::size_t>(list_->indexOfTopLevelItem(item))); });
  column->addWidget(list_);
  column->addWidget(build_uses());
  correct_box_ = new CorrectBox(correction_, this);
  column->addWidget(correct_box_);
  column->addWidget(&correct_box_->out());  // it goes on where the correction ends
  auto* const row = new QHBoxLayout;
  add_tool_button(*row, *this, "palpateAddStructures", tr("Add structures…"),
                  tr("Adds files, DICOM SEG or RTSTRUCT. Those in the scan's folder are found automatically."),
                  [this] { ask_files(); });
  row->addStretch(1);
  row->addWidget(new QLabel(tr("Opacity"), this));
  opacity_ = new QSlider(Qt::Horizontal, this);
  opacity_->setObjectName(QStringLiteral("palpateStructureOpacity"));
  opacity_->setRange(0, 100);
  opacity_->setValue(static_cast<int>(100 * first_opacity));
  opacity_->setMaximumWidth(80);
  opacity_->setToolTip(tr("Opacity of the surfaces in the volume view"));
  connect(opacity_, &QSlider::valueChanged, this, [this] { draw(); });
  row->addWidget(opacity_);
  column->addLayout(row);
  message_ = make_message_label(*this, "palpateStructureMessage");
  column->addWidget(message_);
}

/// The buttons for the uses of the chosen structure, one press each.
QWidget* StructuresSection::build_uses() {
  auto* const box = new QWidget(this);
  auto* const row = new QHBoxLayout(box);
  row->setContentsMargins(0, 0, 0, 0);
  const auto name_of_chosen = [this] { return widget_text(chosen()->structure.name); };
  uses_.push_back(add_tool_button(
      *row, *this, "palpateStructureBoundary", tr("Boundary"),
      tr("The structure's edge resists the stylus like the wall of an organ"), [this, name_of_chosen] {
        use(tr("Boundary of %1").arg(name_of_chosen()),
            [structure = chosen()->structure](modes::Scene& scene) { add_boundary_of(scene, structure); });
      }));
  uses_.push_back(add_tool_button(
      *row, *this, "palpateStructureKeepOut", tr("Keep out"),
      tr("The stylus is pushed back as soon as it is in a margin around the structure"), [this, name_of_chosen] {
        use(tr("Keep out of %1").arg(name_of_chosen()),
            [structure = chosen()->structure, margin = margin_->value()](modes::Scene& scene) {
              add_keep_out_of(scene, structure, margin);
            });
      }));
  margin_ = new QDoubleSpinBox(box);
  margin_->setObjectName(QStringLiteral("palpateStructureMargin"));
  margin_->setRange(0.5, 15);
  margin_->setSingleStep(0.5);
  margin_->setDecimals(1);
  margin_->setValue(first_margin_mm);
  margin_->setSuffix(tr(" mm"));
  margin_->setToolTip(tr("Width of the keep-out margin. The footer warns while the stylus is in it"));
  row->addWidget(margin_);
  auto* const gate =
      add_tool_button(*row, *this, "palpateStructureGate", tr("Only inside"),
                      tr("Choose a mode of the scene that is then felt only inside this structure"), [] {});
  gate->setPopupMode(QToolButton::InstantPopup);
  auto* const menu = new QMenu(gate);
  connect(menu, &QMenu::aboutToShow, this, [this, menu] { fill_gates(*menu); });
  gate->setMenu(menu);
  uses_.push_back(gate);
  correct_ = add_tool_button(*row, *this, "palpateCorrect", tr("Correct"),
                             tr("Lists the doubtful places of the outline and lets you correct it: see the guide"),
                             [this] { correct(correct_->isChecked()); });
  correct_->setCheckable(true);
  uses_.push_back(correct_);
  row->addStretch(1);
  return box;
}

void StructuresSection::fill_gates(QMenu& menu) {
  menu.clear();
  const modes::Scene& scene = model_.scene();
  for (std::size_t n = 0; n < scene.modes.size(); ++n) {
    connect(menu.addAction(name_of(scene, n)), &QAction::triggered, this,
            [this, name = name_of(scene, n), shown = ShownMode(model_, n)] {
              if (!chosen()) return;
              use(tr("%1 only inside %2").arg(name, widget_text(chosen()->structure.name)),
                  [shown, structure = chosen()->structure](modes::Scene& changed) {
                    add_gate_of(changed, shown.in(changed), structure);
                  });
            });
  }
}

void StructuresSection::ask_files() {
  const QStringList files =
      QFileDialog::getOpenFileNames(this, tr("Add structures"), {}, tr("Structures (*.dcm *);;All files (*)"));
  std::vector<std::filesystem::path> places;
  for (const QString& file : files) places.emplace_back(file.toStdString());
  finder_.look_into_asked(places);
}

void StructuresSection::dragEnterEvent(QDragEnterEvent* event) {
  if (scan_ && event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void StructuresSection::dropEvent(QDropEvent* event) {
  std::vector<std::filesystem::path> places;
  for (const QUrl& url : event->mimeData()->urls()) {
    if (url.isLocalFile()) places.emplace_back(url.toLocalFile().toStdString());
  }
  finder_.look_into_asked(places);
}

void StructuresSection::choose_color(std::size_t n) {
  if (n >= entries_.size()) return;
  const io::Structure structure = entries_[n].structure;
  ask_color(*this, widget_text(structure.name), QColor(widget_text(entries_[n].color)),
            [alive = QPointer(this), structure](const QColor& chosen) {
              if (alive) alive->give_color(structure, chosen.name());
            });
}

/// Of another scan, perhaps, when the color comes: then it is in vain.
void StructuresSection::give_color(const io::Structure& structure, const QString& color) {
  const auto entry =
      std::ranges::find_if(entries_, [&](const Entry& one) { return is_same(one.structure, structure); });
  if (entry == entries_.end()) return;
  entry->color = entry->structure.color = color.toStdString();
  const auto in_scene = [structure](const modes::SceneStructure& named) { return is_same(named, structure); };
  if (std::ranges::any_of(model_.scene().structures, in_scene)) {
    model_.edit(tr("Color %1").arg(widget_text(structure.name)), [in_scene, color = entry->color](modes::Scene& scene) {
      const auto named = std::ranges::find_if(scene.structures, in_scene);
      if (named != scene.structures.end()) named->color = color;
    });
  }
  list();
  draw();
}

}  // namespace palpate::plugin
