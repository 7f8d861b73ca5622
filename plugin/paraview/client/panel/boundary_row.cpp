#include "plugin/paraview/client/panel/boundary_row.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QToolButton>

#include <algorithm>
#include <utility>
#include <vector>

#include "modes/scene/boundary_names.h"
#include "modes/types/mode_type.h"
#include "plugin/paraview/client/widgets/color_dialog.h"
#include "plugin/paraview/client/widgets/shortened_edit.h"
#include "plugin/paraview/client/words/mode_words.h"

namespace palpate::plugin {
namespace {

constexpr double strongest_n = 20;

}  // namespace

double strength_of(const modes::Mode& mode) {
  return mode.strength_n.maximum();
}

void scale_strength(modes::Mode& mode, double newtons) {
  const double now = mode.strength_n.maximum();
  if (now <= 0) {
    mode.strength_n = modes::TransferFunction(newtons);
    return;
  }
  std::vector<modes::Node> nodes(mode.strength_n.nodes().begin(), mode.strength_n.nodes().end());
  for (modes::Node& node : nodes) node.value *= newtons / now;
  mode.strength_n = modes::TransferFunction(std::move(nodes), mode.strength_n.interpolation());
}

std::optional<std::size_t> way_back_of(const modes::Scene& scene, std::size_t mode) {
  const modes::Mode& there = scene.modes[mode];
  if (!modes::reads_key(there, modes::Key::tissues) || there.from.empty()) return std::nullopt;
  for (std::size_t n = mode + 1; n < scene.modes.size(); ++n) {
    const modes::Mode& back = scene.modes[n];
    if (modes::reads_key(back, modes::Key::tissues) && back.from == there.to && back.to == there.from) return n;
  }
  return std::nullopt;
}

BoundaryRow::BoundaryRow(SceneModel& model, std::size_t mode, int row, QWidget& parent, QGridLayout& grid)
    : model_(model), mode_(mode), back_(way_back_of(model.scene(), mode)) {
  add_switch(parent, grid, row);
  add_name(parent, grid, row);
  if (back_) add_direction(parent, grid, row);
  add_strength(parent, grid, row);
}

BoundaryRow::Shown::Pair BoundaryRow::Shown::in(modes::Scene& scene) const {
  return {&scene.modes[there.in(scene)], back ? &scene.modes[back->in(scene)] : nullptr};
}

BoundaryRow::Shown BoundaryRow::shown() const {
  return {{model_, mode_}, back_ ? std::optional(ShownMode(model_, *back_)) : std::nullopt};
}

/// The way back is the same boundary.
void BoundaryRow::edit(const QString& what, const std::function<void(modes::Mode&)>& change) {
  model_.edit(what, [change, shown = shown()](modes::Scene& scene) {
    const auto [there, back] = shown.in(scene);
    change(*there);
    if (back) change(*back);
  });
}

void BoundaryRow::set_felt(const QString& what, bool felt) {
  const int direction = direction_ ? direction_->currentIndex() : in;
  model_.edit(what, [felt, direction, shown = shown()](modes::Scene& scene) {
    const auto [there, back] = shown.in(scene);
    there->enabled = felt && direction != out;
    if (back) back->enabled = felt && direction != in;
  });
}

bool BoundaryRow::is_felt() const {
  return of_scene().enabled || (back_ && model_.scene().modes[*back_].enabled);
}

void BoundaryRow::add_switch(QWidget& parent, QGridLayout& grid, int row) {
  const QString number = QString::number(row);
  on_ = new QCheckBox(&parent);
  on_->setObjectName(QStringLiteral("palpateOn") + number);
  on_->setToolTip(tr("Turns the boundary on or off"));
  connect(on_, &QCheckBox::clicked, this, [this](bool checked) {
    const QString name = name_of(model_.scene(), mode_);
    set_felt(checked ? tr("Switch on %1").arg(name) : tr("Switch off %1").arg(name), checked);
  });
  grid.addWidget(on_, row, 0);
  color_ = new QToolButton(&parent);
  color_->setObjectName(QStringLiteral("palpateColor") + number);
  color_->setFixedSize(18, 18);
  color_->setToolTip(tr("The boundary's color, here and in the views"));
  connect(color_, &QToolButton::clicked, this, [this] { choose_color(); });
  grid.addWidget(color_, row, 1);
}

void BoundaryRow::choose_color() {
  const QString name = name_of(model_.scene(), mode_);
  ask_color(*color_, name, color_of(of_scene()), [name, shown = shown(), &model = model_](const QColor& chosen) {
    model.edit(tr("Color %1").arg(name), [shown, color = chosen.name().toStdString()](modes::Scene& scene) {
      const auto [there, back] = shown.in(scene);
      there->color = color;
      if (back) back->color = color;
    });
  });
}

void BoundaryRow::add_name(QWidget& parent, QGridLayout& grid, int row) {
  name_ = new ShortenedEdit(&parent);
  name_->setObjectName(QStringLiteral("palpateName") + QString::number(row));
  connect(name_, &QLineEdit::editingFinished, this, [this] {
    const QString was = name_of(model_.scene(), mode_);
    if (name_->text() == was) return;
    const std::string name = name_->text().toStdString();
    model_.edit(tr("Rename %1").arg(was), [name, shown = shown()](modes::Scene& scene) {
      const auto [there, back] = shown.in(scene);
      there->name = name;
      if (back && !name.empty()) back->name = modes::way_back_name(name);
    });
  });
  grid.addWidget(name_, row, name_column);
}

void BoundaryRow::add_direction(QWidget& parent, QGridLayout& grid, int row) {
  direction_ = new QComboBox(&parent);
  direction_->setObjectName(QStringLiteral("palpateDirection") + QString::number(row));
  direction_->addItems({tr("in"), tr("out"), tr("both")});
  direction_->setToolTip(
      tr("The direction in which the stylus is resisted: into the denser tissue, out of it, or both"));
  connect(direction_, QOverload<int>::of(&QComboBox::activated), this,
          [this] { set_felt(tr("Direction of %1").arg(name_of(model_.scene(), mode_)), true); });
  grid.addWidget(direction_, row, name_column + 1);
}

void BoundaryRow::add_strength(QWidget& parent, QGridLayout& grid, int row) {
  const QString number = QString::number(row);
  strength_ = new QDoubleSpinBox(&parent);
  strength_->setObjectName(QStringLiteral("palpateStrength") + number);
  strength_->setRange(0, strongest_n);
  strength_->setDecimals(2);
  strength_->setSingleStep(0.1);
  strength_->setSuffix(tr(" N"));
  strength_->setKeyboardTracking(false);
  strength_->setToolTip(tr("The force at which the stylus breaks through this boundary"));
  connect(strength_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, [this](double newtons) {
    edit(tr("Strength of %1").arg(name_of(model_.scene(), mode_)),
         [newtons](modes::Mode& mode) { scale_strength(mode, newtons); });
  });
  grid.addWidget(strength_, row, name_column + 2);
  alike_ = new QLabel(QStringLiteral("≈"), &parent);
  alike_->setObjectName(QStringLiteral("palpateAlike") + number);
  alike_->setStyleSheet(QStringLiteral("color: #d55e00; font-weight: bold"));
  alike_->hide();
  grid.addWidget(alike_, row, name_column + 3);
}

void BoundaryRow::show_values() {
  const modes::Mode& mode = of_scene();
  const QString name = name_of(model_.scene(), mode_);
  on_->setChecked(is_felt());
  color_->setStyleSheet(QStringLiteral("background: %1; border: 1px solid palette(dark)").arg(color_of(mode).name()));
  if (!name_->hasFocus() || name_->text().isEmpty()) {
    name_->setText(name);
    name_->setCursorPosition(0);
  }
  name_->setToolTip(name);
  if (direction_ && is_felt()) {
    const bool back = model_.scene().modes[*back_].enabled;
    direction_->setCurrentIndex(mode.enabled && back ? both : back ? out : in);
  }
  const QSignalBlocker quiet(strength_);
  strength_->setValue(strength_of(mode));
}

void BoundaryRow::set_alike(const QStringList& others) {
  alike_->setVisible(!others.isEmpty());
  alike_->setToolTip(
      tr("A hand cannot tell this strength from that of %1: it feels only differences of a tenth or more.")
          .arg(others.join(QStringLiteral(", "))));
}

}  // namespace palpate::plugin
