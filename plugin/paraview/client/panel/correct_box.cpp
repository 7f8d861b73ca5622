#include "plugin/paraview/client/panel/correct_box.h"

#include <QButtonGroup>
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>

#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "plugin/paraview/client/panel/outline_out.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/widgets/row_list.h"
#include "plugin/paraview/client/widgets/tool_button.h"

namespace palpate::plugin {
namespace {

using Tool = CorrectionModel::Tool;

QString doubt_in_words(const io::DoubtfulPlace& place) {
  const auto mm = [](double length) { return QString::number(std::abs(length), 'f', 1); };
  switch (place.kind) {
    case io::DoubtKind::edge:
      return (place.mean_mm > 0 ? CorrectBox::tr("scan's edge up to %1 mm outside (±%2 mm)")
                                : CorrectBox::tr("scan's edge up to %1 mm inside (±%2 mm)"))
          .arg(mm(place.largest_mm), mm(place.known_to_mm));
    case io::DoubtKind::no_edge:
      return CorrectBox::tr("no edge in the scan: the tissue is the same on both sides");
    case io::DoubtKind::island:
      return CorrectBox::tr("a small separate part");
    case io::DoubtKind::hole:
      return CorrectBox::tr("a small hole");
  }
  return {};
}

/// Named by the nearest axis, since a scan may be oblique.
QString held_in_words(const io::Vec3& normal) {
  const io::Vec3 part = glm::abs(normal);
  if (part.z >= part.x && part.z >= part.y) return CorrectBox::tr("The stylus is held in the axial slice");
  return part.y >= part.x ? CorrectBox::tr("The stylus is held in the coronal slice")
                          : CorrectBox::tr("The stylus is held in the sagittal slice");
}

}  // namespace

CorrectBox::CorrectBox(CorrectionModel& model, QWidget* parent) : QWidget(parent), model_(model) {
  setObjectName(QStringLiteral("palpateCorrectBox"));
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(3);
  places_note_ = make_message_label(*this, "palpateDoubtfulNote");
  column->addWidget(places_note_);
  places_ = make_row_list(*this, "palpateDoubtfulPlaces", 1, 90);
  places_->setToolTip(tr("Places at which the outline is doubtful, the most doubtful first. A click goes there."));
  connect(places_, &QTreeWidget::itemClicked, this, [this](QTreeWidgetItem* item) {
    model_.go_to(static_cast<std::size_t>(places_->indexOfTopLevelItem(item)));
    follow();
  });
  column->addWidget(places_);
  column->addWidget(build_tools());
  change_ = make_message_label(*this, "palpateCorrectChange");
  column->addWidget(change_);
  column->addWidget(build_ways_out());
  out_ = new OutlineOut(this);
  connect(out_, &OutlineOut::told, this, [this] { follow(); });
  connect(&model, &CorrectionModel::changed, this, [this] { follow(); });
  connect(&model, &CorrectionModel::places_changed, this, [this] { list_places(); });
  list_places();
  follow();
}

QWidget* CorrectBox::build_tools() {
  auto* const box = new QWidget(this);
  auto* const rows = new QVBoxLayout(box);
  rows->setContentsMargins(0, 0, 0, 0);
  rows->setSpacing(3);
  auto* const places = new QHBoxLayout;
  take_ = add_tool_button(
      *places, *this, "palpateTakeScanEdge", tr("Take the scan's edge"),
      tr("Moves the outline to the scan's own edge at this place"), [this] {
        if (model_.doubtful().at())
          model_.take_scan_edge(model_.doubtful().places()->places[*model_.doubtful().at()].position_mm);
      });
  leave_ = add_tool_button(*places, *this, "palpateLeavePlace", tr("Leave it"),
                           tr("Marks the outline as correct at this place"), [this] {
                             if (model_.doubtful().at()) model_.leave(*model_.doubtful().at());
                           });
  places->addStretch(1);
  rows->addLayout(places);
  auto* const row = new QHBoxLayout;
  tools_ = new QButtonGroup(box);
  const auto add_tool = [&](Tool tool, const char* name, const QString& text, const QString& tip) {
    QToolButton* const button = add_tool_button(*row, *this, name, text, tip, [this, tool] { model_.set_tool(tool); });
    button->setCheckable(true);
    tools_->addButton(button, static_cast<int>(tool));
  };
  add_tool(Tool::trace, "palpateToolTrace", tr("Trace"),
           tr("Drag along the true edge in a slice: the outline moves to your line. Or hold M while the stylus touches "
              "the edge. In the volume view drag over the outline: there it moves to the scan's own edge."));
  add_tool(Tool::add, "palpateToolAdd", tr("Add"), tr("Adds to the structure what the ball passes over"));
  add_tool(Tool::remove, "palpateToolRemove", tr("Remove"), tr("Removes from the structure what the ball passes over"));
  const auto add_number = [&](const char* name, double low, double high, double step, const QString& unit,
                              const QString& tip) {
    auto* const number = new QDoubleSpinBox(box);
    number->setObjectName(QString::fromLatin1(name));
    number->setRange(low, high);
    number->setSingleStep(step);
    number->setDecimals(1);
    number->setSuffix(unit);
    number->setKeyboardTracking(false);
    number->setToolTip(tip);
    row->addWidget(number);
    return number;
  };
  radius_ = add_number("palpateCorrectRadius", 0.5, 30, 0.5, tr(" mm"), tr("Radius of what is added or removed"));
  connect(radius_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
          [this](double mm) { model_.set_radius_mm(mm); });
  snap_ = add_number("palpateCorrectSnap", 0, 3, 0.2, tr(" N"), tr("How strongly the scan's edge holds the stylus"));
  connect(snap_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
          [this](double newtons) { model_.set_snap_n(newtons); });
  row->addStretch(1);
  rows->addLayout(row);
  in_slice_ = new QCheckBox(box);
  in_slice_->setObjectName(QStringLiteral("palpateHoldInSlice"));
  in_slice_->setToolTip(
      tr("The stylus stays in the slice of the active view while it traces. Hold F in a view to free it."));
  connect(in_slice_, &QCheckBox::clicked, this, &CorrectBox::slice_wanted);
  rows->addWidget(in_slice_, 0, Qt::AlignLeft);
  return box;
}

QWidget* CorrectBox::build_ways_out() {
  auto* const box = new QWidget(this);
  auto* const row = new QHBoxLayout(box);
  row->setContentsMargins(0, 0, 0, 0);
  undo_ = add_tool_button(*row, *this, "palpateCorrectUndo", tr("Undo"), tr("Takes back the last correction"),
                          [this] { model_.undo(); });
  redo_ = add_tool_button(*row, *this, "palpateCorrectRedo", tr("Redo"), tr("Applies the undone correction again"),
                          [this] { model_.redo(); });
  before_ = add_tool_button(
      *row, *this, "palpateCorrectBefore", tr("Before"),
      tr("While this button, or the key B in a view, is pressed, the outline of the file is shown"), [] {});
  connect(before_, &QToolButton::pressed, this, [this] { model_.show_before(true); });
  connect(before_, &QToolButton::released, this, [this] { model_.show_before(false); });
  row->addStretch(1);
  const auto add_button = [&](const char* name, const QString& text, const QString& tip, auto wanted) {
    auto* const button = new QPushButton(text, box);
    button->setObjectName(QString::fromLatin1(name));
    button->setToolTip(tip);
    connect(button, &QPushButton::clicked, this, wanted);
    row->addWidget(button);
    return button;
  };
  save_ = add_button("palpateCorrectSave", tr("Save…"),
                     tr("Saves it as DICOM SEG or RTSTRUCT, NIfTI, NRRD or MetaImage"), &CorrectBox::save_wanted);
  send_ = add_button("palpateCorrectSend", tr("Send…"),
                     tr("Sends the outline to an archive. First shows what is sent, and for which patient."),
                     &CorrectBox::send_wanted);
  return box;
}

void CorrectBox::set_change(const QString& words) {
  show_message(*change_, words, false);
}

void CorrectBox::set_looking(double done) {
  looking_ = done;
  list_places();
}

void CorrectBox::set_whole(bool whole) {
  if (std::exchange(whole_, whole) != whole) follow();
}

void CorrectBox::follow() {
  setVisible(model_.structure() != nullptr);
  const QSignalBlocker quiet_radius(radius_), quiet_snap(snap_);
  tools_->button(static_cast<int>(model_.tool()))->setChecked(true);
  radius_->setValue(model_.radius_mm());
  radius_->setEnabled(model_.tool() != Tool::trace);
  snap_->setValue(model_.snap_n());
  in_slice_->setChecked(model_.held_in().has_value());
  in_slice_->setText(!model_.held_in()   ? tr("Hold the stylus in the slice")
                     : model_.is_freed() ? tr("Free while F is held")
                                         : held_in_words(model_.held_in()->normal));
  undo_->setEnabled(model_.can_undo());
  redo_->setEnabled(model_.can_redo());
  before_->setEnabled(model_.is_edited());
  before_->setDown(model_.shows_before());
  const bool goes_out = model_.is_edited() && !model_.is_tracing() && whole_ && !out_->is_busy();
  save_->setEnabled(goes_out);
  send_->setEnabled(goes_out);
  take_->setEnabled(model_.doubtful().at() &&
                    model_.doubtful().places()->places[*model_.doubtful().at()].kind == io::DoubtKind::edge);
  leave_->setEnabled(model_.doubtful().at().has_value());
}

void CorrectBox::show_place(QTreeWidgetItem& item, std::size_t place) const {
  const io::DoubtfulPlace& shown = model_.doubtful().places()->places[place];
  constexpr double mm2 = 100;
  item.setText(0, tr("%1 cm²").arg(shown.area_mm2 / mm2, 0, 'f', 1));
  const DoubtfulList::Fate fate = model_.doubtful().fate(place);
  const QString doubt = doubt_in_words(shown);
  item.setText(1, fate == DoubtfulList::Fate::corrected ? tr("corrected: %1").arg(doubt)
                  : fate == DoubtfulList::Fate::left    ? tr("kept: %1").arg(doubt)
                                                        : doubt);
  item.setToolTip(1, item.text(1));
  for (const int part : {0, 1}) {
    QFont font = item.font(part);
    font.setStrikeOut(fate != DoubtfulList::Fate::doubtful);
    item.setFont(part, font);
  }
}

void CorrectBox::list_places() {
  const std::size_t count = model_.doubtful().places() ? model_.doubtful().places()->places.size() : 0;
  while (places_->topLevelItemCount() > static_cast<int>(count)) {
    delete places_->takeTopLevelItem(places_->topLevelItemCount() - 1);
  }
  for (std::size_t n = 0; n < count; ++n) {
    if (static_cast<int>(n) >= places_->topLevelItemCount()) places_->addTopLevelItem(new QTreeWidgetItem);
    show_place(*places_->topLevelItem(static_cast<int>(n)), n);
  }
  places_->setVisible(count > 0);
  show_message(*places_note_, note_of_places(), false);
  follow();
}

QString CorrectBox::note_of_places() const {
  if (looking_ >= 0) return tr("Looking for doubtful places, %1 %").arg(std::lround(100 * looking_));
  if (!model_.doubtful().places()) return {};
  const std::size_t count = model_.doubtful().places()->places.size();
  if (count == 0) return tr("No doubtful place was found.");
  return count == 1 ? tr("1 doubtful place") : tr("%1 doubtful places").arg(count);
}

}  // namespace palpate::plugin
