#include "plugin/paraview/client/panel/marks_section.h"

#include <QHBoxLayout>
#include <QPointer>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "plugin/paraview/client/panel/marks_sender.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/widgets/row_list.h"
#include "plugin/paraview/client/widgets/tool_button.h"

namespace palpate::plugin {
namespace {

QString text(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

QString length_in_words(double mm) {
  return QStringLiteral("%1 mm").arg(mm, 0, 'f', 2);
}

QString place_in_words(const glm::dvec3& at) {
  return QStringLiteral("%1, %2, %3 mm (LPS)").arg(at.x, 0, 'f', 2).arg(at.y, 0, 'f', 2).arg(at.z, 0, 'f', 2);
}

}  // namespace

MarksSection::MarksSection(MarksModel& model, SessionController& session, QWidget* parent)
    : QWidget(parent), model_(model), session_(session) {
  setObjectName(QStringLiteral("palpateMarks"));
  build();
  connect(&model, &MarksModel::changed, this, [this] { list(); });
  connect(&model, &MarksModel::refused, this, [this](const QString& why) { tell(why, true); });
  connect(&session, &SessionController::polled, this, [this] { show_uses(); });
  connect(&session, &SessionController::felt_scan_changed, this, [this] { list(); });  // with its unit
  list();
  tell({});
}

void MarksSection::build() {
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(3);
  list_ = make_row_list(*this, "palpateMarkList", 1, 130);
  list_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  list_->setEditTriggers(QAbstractItemView::EditKeyPressed | QAbstractItemView::SelectedClicked);
  list_->setToolTip(
      tr("Choose two marks for their distance, three for the angle at the second. A double click goes to a mark; F2 "
         "renames it."));
  connect(list_, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item) {
    if (!listing_) rename(*item);
  });
  connect(list_, &QTreeWidget::itemSelectionChanged, this, [this] {
    if (!listing_) follow_choice();
  });
  connect(list_, &QTreeWidget::itemDoubleClicked, this, [this](QTreeWidgetItem* item) {
    const MarkRow row = row_of(*item);
    if (row.kind == Kind::mark) emit place_wanted(model_.marks().points[row.index].position_mm);
    if (row.kind == Kind::path) emit place_wanted(model_.marks().paths[row.index].points_mm.front());
  });
  column->addWidget(list_);
  measured_ = make_message_label(*this, "palpateMeasured");
  column->addWidget(measured_);
  auto* const row = new QHBoxLayout;
  keep_ = add_tool_button(*row, *this, "palpateKeepMeasure", tr("Keep"),
                          tr("The distance or angle stays in the list and in the views"), [this] { keep_measure(); });
  move_ = add_tool_button(*row, *this, "palpateMoveMark", tr("Move here"),
                          tr("Moves the mark to the point that the stylus touches now"), [this] { move_here(); });
  remove_ = add_tool_button(*row, *this, "palpateDeleteMark", tr("Delete"), tr("Deletes what is chosen in the list"),
                            [this] { remove(); });
  undo_ = add_tool_button(*row, *this, "palpateUndoMark", tr("Undo"),
                          tr("Takes back the last change of the marks or of the scene"), [this] { model_.undo(); });
  row->addStretch(1);
  send_ = new QPushButton(tr("Send…"), this);
  send_->setObjectName(QStringLiteral("palpateSendMarks"));
  send_->setToolTip(tr("Sends the marks to an archive. First shows what is sent, and for which patient."));
  connect(send_, &QPushButton::clicked, this, &MarksSection::send_wanted);
  row->addWidget(send_);
  column->addLayout(row);
  sender_ = new MarksSender(this);
  connect(sender_, &MarksSender::told, this, &MarksSection::tell);
  column->addWidget(sender_);
  message_ = make_message_label(*this, "palpateMarkMessage");
  column->addWidget(message_);
}

QString MarksSection::unit() const {
  if (session_.expects_scan()) return {};  // what is felt is the one before
  return session_.live().scan() ? text(session_.live().scan()->unit) : QString();
}

MarkRow MarksSection::row_of(const QTreeWidgetItem& item) const {
  const int at = list_->indexOfTopLevelItem(const_cast<QTreeWidgetItem*>(&item));
  return rows_of(model_.marks())[static_cast<std::size_t>(at)];
}

QString MarksSection::path_in_words(const MarkedPath& path) const {
  const QString length = length_in_words(path.length_mm);
  switch (contact_of(path)) {
    case PathContact::all_along:
      return tr("%1 along the surface").arg(length);
    case PathContact::nowhere:
      return tr("%1 without contact").arg(length);
    case PathContact::partly:
      return tr("%1, of which %2 along the surface").arg(length, length_in_words(path.touched_mm));
    case PathContact::unknown:
      break;
  }
  return length;
}

void MarksSection::fill(QTreeWidgetItem& item, const MarkRow& row) {
  const Marks& marks = model_.marks();
  const auto name = [&](std::size_t mark) { return text(marks.points[mark].name); };
  QString what, tip;
  Qt::ItemFlags flags = Qt::ItemIsEnabled | Qt::ItemIsSelectable;
  if (row.kind == Kind::mark || row.kind == Kind::path) flags |= Qt::ItemIsEditable;
  if (item.flags() != flags) item.setFlags(flags);  // it would bring back the name in an editor
  switch (row.kind) {
    case Kind::mark: {
      const FeltMark& mark = marks.points[row.index];
      item.setText(0, text(mark.name));
      QStringList parts{mark.boundary.empty() ? tr("no boundary felt") : text(mark.boundary)};
      if (std::isfinite(mark.value)) parts << QStringLiteral("%1 %2").arg(mark.value, 0, 'g', 4).arg(unit()).trimmed();
      parts << tr("%1 N").arg(mark.force_n, 0, 'f', 2);
      what = parts.join(QStringLiteral(" · "));
      tip = tr("%1\n%2 s after the session began").arg(place_in_words(mark.position_mm)).arg(mark.time_s, 0, 'f', 2);
      break;
    }
    case Kind::path: {
      const MarkedPath& path = marks.paths[row.index];
      item.setText(0, text(path.name));
      what = path_in_words(path);
      tip = tr("%1 to %2").arg(place_in_words(path.points_mm.front()), place_in_words(path.points_mm.back()));
      break;
    }
    case Kind::distance: {
      const MarkedDistance& of = marks.distances[row.index];
      item.setText(0, tr("%1 to %2").arg(name(of.from), name(of.to)));
      what = length_in_words(of.mm);
      break;
    }
    case Kind::angle: {
      const MarkedAngle& of = marks.angles[row.index];
      item.setText(0, tr("Angle at %1").arg(name(of.at)));
      what = tr("%1°").arg(of.degrees, 0, 'f', 1);
      tip = tr("Between %1 and %2").arg(name(of.from), name(of.to));
    }
  }
  item.setText(1, what);
  item.setToolTip(0, tip);
  item.setToolTip(1, tip.isEmpty() ? what : what + QLatin1Char('\n') + tip);
}

void MarksSection::list() {
  if (std::exchange(listing_, true)) return;
  // An item of the list stays that of the same mark, and with it the choice and a name that is being typed.
  const QPointer<QLineEdit> editor = list_->viewport()->findChild<QLineEdit*>();
  const QString typed = editor ? editor->text() : QString();
  const Marks now = model_.marks();
  const auto former = former_rows(listed_of_ == model_.scan() ? listed_ : Marks(), now);
  std::vector<std::size_t> chosen;  // marks are the first rows
  for (const std::size_t mark : chosen_) {
    const auto at = std::ranges::find(former, std::optional(mark));
    if (at != former.end()) chosen.push_back(static_cast<std::size_t>(at - former.begin()));
  }
  chosen_ = std::move(chosen);
  for (int n = list_->topLevelItemCount() - 1; n >= 0; --n) {
    if (std::ranges::find(former, std::optional(static_cast<std::size_t>(n))) == former.end()) {
      delete list_->takeTopLevelItem(n);
    }
  }
  const std::vector<MarkRow> rows = rows_of(now);
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const int at = static_cast<int>(n);
    if (!former[n]) list_->insertTopLevelItem(at, new QTreeWidgetItem);
    fill(*list_->topLevelItem(at), rows[n]);
  }
  if (editor && editor->text() != typed) editor->setText(typed);  // Qt may have brought back the name
  listed_ = now;
  listed_of_ = model_.scan();
  listing_ = false;
  follow_choice();
  emit listed();
}

void MarksSection::follow_choice() {
  std::set<std::size_t> now;
  for (const QTreeWidgetItem* const item : list_->selectedItems()) {
    if (const MarkRow row = row_of(*item); row.kind == Kind::mark) now.insert(row.index);
  }
  std::erase_if(chosen_, [&](std::size_t mark) { return !now.contains(mark); });
  for (const std::size_t mark : now) {
    if (std::ranges::find(chosen_, mark) == chosen_.end()) chosen_.push_back(mark);
  }
  show_measure();
  show_uses();
  emit chosen(chosen_);
}

void MarksSection::show_measure() {
  const Marks& marks = model_.marks();
  QString words;
  if (chosen_.size() == 2) {
    words = tr("%1 from %2 to %3")
                .arg(length_in_words(distance_mm(marks, chosen_[0], chosen_[1])), text(marks.points[chosen_[0]].name),
                     text(marks.points[chosen_[1]].name));
  } else if (chosen_.size() == 3) {
    const auto degrees = angle_degrees(marks, chosen_[0], chosen_[1], chosen_[2]);
    if (degrees) words = tr("%1° at %2").arg(*degrees, 0, 'f', 1).arg(text(marks.points[chosen_[1]].name));
  }
  measured_->setText(words);
  measured_->setVisible(!words.isEmpty());
}

void MarksSection::show_uses() {
  const bool any = list_->topLevelItemCount() > 0;
  keep_->setEnabled(!measured_->text().isEmpty());
  remove_->setEnabled(!list_->selectedItems().isEmpty());
  const SessionStatus& look = session_.last();
  move_->setEnabled(chosen_.size() == 1 && look.connected && look.fresh && !look.clutched);
  send_->setEnabled(any && !sender_->is_busy());
}

void MarksSection::rename(const QTreeWidgetItem& item) {
  const MarkRow row = row_of(item);
  const std::string name = item.text(0).trimmed().toStdString();
  if (!name.empty()) {
    model_.edit(tr("Rename to %1").arg(text(name)), [&](Marks& marks) {
      (row.kind == Kind::path ? marks.paths[row.index].name : marks.points[row.index].name) = name;
    });
  }
  list();  // an empty name is none
}

void MarksSection::keep_measure() {
  if (chosen_.size() == 2) {
    model_.edit(tr("Keep a distance"),
                [this](Marks& marks) { marks.distances.push_back({.from = chosen_[0], .to = chosen_[1]}); });
  } else if (chosen_.size() == 3) {
    model_.edit(tr("Keep an angle"), [this](Marks& marks) {
      marks.angles.push_back({.from = chosen_[0], .at = chosen_[1], .to = chosen_[2]});
    });
  }
}

/// All that it says is of the new place.
void MarksSection::move_here() {
  if (chosen_.size() != 1) return;
  const FeltMark here = session_.mark_here();
  model_.edit(tr("Move %1").arg(text(model_.marks().points[chosen_[0]].name)), [&](Marks& marks) {
    FeltMark& mark = marks.points[chosen_[0]];
    std::string name = std::move(mark.name);
    mark = here;
    mark.name = std::move(name);
  });
}

void MarksSection::remove() {
  std::vector<MarkRow> gone;
  for (const QTreeWidgetItem* const item : list_->selectedItems()) gone.push_back(row_of(*item));
  // From the last to the first, and measures before the marks that they are of, so that indices stay right.
  std::ranges::sort(
      gone, [](const MarkRow& a, const MarkRow& b) { return a.kind != b.kind ? a.kind > b.kind : a.index > b.index; });
  list_->clearSelection();
  model_.edit(tr("Delete marks"), [&](Marks& marks) {
    const auto erase = [](auto& from, std::size_t n) { from.erase(from.begin() + static_cast<std::ptrdiff_t>(n)); };
    for (const MarkRow& row : gone) {
      if (row.kind == Kind::mark) remove_mark(marks, row.index);
      if (row.kind == Kind::path) erase(marks.paths, row.index);
      if (row.kind == Kind::distance) erase(marks.distances, row.index);
      if (row.kind == Kind::angle) erase(marks.angles, row.index);
    }
  });
}

QString MarksSection::in_words() const {
  const Marks& marks = model_.marks();
  QStringList parts;
  if (!marks.points.empty()) parts << QString::number(marks.points.size());
  if (!marks.paths.empty()) parts << (marks.paths.size() == 1 ? tr("1 path") : tr("%1 paths").arg(marks.paths.size()));
  return parts.join(QStringLiteral(", "));
}

void MarksSection::tell(const QString& message, bool problem) {
  show_message(*message_, message, problem);
  show_uses();  // what is told begins or ends a sending
}

}  // namespace palpate::plugin
