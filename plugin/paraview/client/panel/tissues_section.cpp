#include "plugin/paraview/client/panel/tissues_section.h"

#include <QCheckBox>
#include <QColorDialog>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFile>
#include <QFileDialog>
#include <QFileInfo>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QSaveFile>
#include <QSignalBlocker>
#include <QToolButton>

#include <algorithm>
#include <exception>
#include <vector>

#include "modes/scene/scene_json.h"
#include "modes/types/mode_type.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/panel/column_scroll.h"
#include "plugin/paraview/client/panel/mode_words.h"
#include "plugin/paraview/client/panel/tool_button.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {
namespace {

constexpr double strongest_n = 20;

/// How the hand reaches the scan and is protected is the user's, whichever scene is felt.
modes::Scene with_hand_of(modes::Scene scene, const modes::Scene& now) {
  scene.workspace = now.workspace;
  scene.limits = now.limits;
  scene.stiffness_n_per_m = now.stiffness_n_per_m;
  return scene;
}

/// What is felt in it, to tell scenes apart.
std::string text_of(const modes::Scene& scene) {
  return modes::to_json(with_hand_of(scene, {}));
}

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

TissuesSection::TissuesSection(SceneModel& model, QWidget* parent) : QWidget(parent), model_(model) {
  setObjectName(QStringLiteral("palpateTissues"));
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(3);
  auto* const top = new QHBoxLayout;
  scenes_ = new QComboBox(this);
  scenes_->setObjectName(QStringLiteral("palpateScenes"));
  scenes_->setToolTip(tr("A scene says what is felt. The first was found in this scan."));
  scenes_->addItem(QString());
  choices_.push_back({tr("Found in this scan"), {}, {}});
  for (const std::string& name : modes::starting_scenes()) {
    const modes::Scene scene = modes::load_scene(name);
    add_choice(QString::fromStdString(scene.name), scene);
  }
  show_origin();
  connect(scenes_, QOverload<int>::of(&QComboBox::activated), this, [this](int index) { choose_scene(index); });
  scenes_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  scenes_->setMinimumContentsLength(10);
  top->addWidget(scenes_, 1);
  add_tool_button(*top, *this, "palpateOpenScene", tr("Open…"), tr("A scene's file"), [this] { open_file(); });
  add_tool_button(*top, *this, "palpateSaveScene", tr("Save…"), tr("Keeps this scene in a file"),
                  [this] { save_file(); });
  column->addLayout(top);
  rows_ = new QWidget(this);
  scroll_ = new ColumnScroll(QStringLiteral("palpateBoundaries"), rows_, this);
  column->addWidget(scroll_);
  message_ = new QLabel(this);
  message_->setObjectName(QStringLiteral("palpateSceneMessage"));
  message_->setWordWrap(true);
  message_->setStyleSheet(QStringLiteral("color: #b00020"));
  message_->hide();
  column->addWidget(message_);
  connect(&model, &SceneModel::changed, this, [this](Pace pace) {
    message_->hide();
    if (pace == Pace::stepped) follow_origin();
    show_values();
  });
  connect(&model, &SceneModel::refused, this, [this](const QString& why) {
    message_->setText(why);
    message_->show();
    show_origin();
    show_values();
  });
  build_rows();
}

void TissuesSection::set_proposed(const modes::Scene& scene) {
  choices_.front().scene = scene;
  choices_.front().text = text_of(scene);
  follow_origin();
}

void TissuesSection::forget_scan() {
  choices_.front() = {tr("Found in this scan"), {}, {}};
  edited_from_.clear();
  follow_origin();
}

void TissuesSection::set_restored() {
  choice_ = add_choice(tr("Restored with the state"), model_.scene());
  follow_origin();
}

QString TissuesSection::scene_in_words() const {
  return scenes_->currentText();
}

int TissuesSection::add_choice(const QString& label, const modes::Scene& scene) {
  const auto same = std::ranges::find(choices_, label, &Choice::label);
  const auto item = static_cast<int>(same - choices_.begin());
  if (same == choices_.end()) {
    choices_.push_back({label, scene, text_of(scene)});
    scenes_->addItem(label);
  } else {
    *same = {label, scene, text_of(scene)};
  }
  return item;
}

/// An edit leaves the choice that it was made of, and undoing it leads back there.
void TissuesSection::follow_origin() {
  const std::string text = text_of(model_.scene());
  const auto is_this = [&](int item) { return choices_[static_cast<std::size_t>(item)].text == text; };
  std::optional<int> found;
  if (choosing_ && is_this(*choosing_)) found = choosing_;
  if (!found && is_this(choice_)) found = choice_;
  for (int item = 0; !found && item < static_cast<int>(choices_.size()); ++item) {
    if (is_this(item)) found = item;
  }
  edited_ = !found;
  if (found) {
    choice_ = *found;
  } else {
    choice_ = edited_from_.emplace(text, choice_).first->second;
  }
  show_origin();
}

void TissuesSection::show_origin() {
  const QSignalBlocker quiet(scenes_);
  for (int item = 0; item < static_cast<int>(choices_.size()); ++item) {
    const QString& label = choices_[static_cast<std::size_t>(item)].label;
    scenes_->setItemText(item, item == choice_ && edited_ ? tr("%1, edited").arg(label) : label);
  }
  scenes_->setCurrentIndex(choice_);
}

void TissuesSection::choose_scene(int index) {
  if (choices_[static_cast<std::size_t>(index)].text.empty()) {  // still being looked for
    show_origin();
    return;
  }
  choose(index, tr("Choose scene"));
}

void TissuesSection::choose(int item, const QString& what) {
  choosing_ = item;
  model_.edit(
      what, [&](modes::Scene& scene) { scene = with_hand_of(choices_[static_cast<std::size_t>(item)].scene, scene); });
  choosing_.reset();
}

void TissuesSection::open_file() {
  const QString file = QFileDialog::getOpenFileName(this, tr("Open scene"), {}, tr("Scenes (*.json)"));
  if (file.isEmpty()) return;
  try {
    choose(add_choice(QFileInfo(file).fileName(), modes::load_scene(file.toStdString())), tr("Open scene"));
  } catch (const std::exception& error) {
    emit model_.refused(QString::fromUtf8(error.what()));
  }
}

void TissuesSection::save_file() {
  QFileDialog dialog(this, tr("Save scene"), {}, tr("Scenes (*.json)"));
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QStringLiteral("json"));
  dialog.selectFile(QStringLiteral("scene.json"));
  if (dialog.exec() != QDialog::Accepted || dialog.selectedFiles().isEmpty()) return;
  const QString name = dialog.selectedFiles().first();
  QSaveFile file(name);
  const std::string text = modes::to_json(model_.scene());
  const auto size = static_cast<qint64>(text.size());
  if (!file.open(QIODevice::WriteOnly) || file.write(text.data(), size) != size || !file.commit()) {
    emit model_.refused(words(say("panel-cannot-write", name.toStdString(), file.errorString().toStdString())));
  }
}

void TissuesSection::build_rows() {
  delete grid_;
  qDeleteAll(rows_->findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly));
  grid_ = new QGridLayout(rows_);
  grid_->setContentsMargins(0, 0, 0, 0);
  grid_->setHorizontalSpacing(4);
  grid_->setVerticalSpacing(1);
  grid_->setColumnStretch(2, 1);
  const modes::Scene& scene = model_.scene();
  shown_.clear();
  shown_types_.clear();
  for (const modes::Mode& mode : scene.modes) shown_types_.push_back(mode.type);
  // Where it has no boundaries, as in a flow, whatever else it has.
  const auto is_boundary = [](const modes::Mode& mode) {
    return mode.type == "surface" || modes::contains(modes::find_mode_type(mode.type)->keys, modes::Key::margin);
  };
  const bool any_surface = std::ranges::any_of(scene.modes, is_boundary);
  for (std::size_t n = 0; n < scene.modes.size(); ++n) {
    if (any_surface && !is_boundary(scene.modes[n])) continue;
    const int row = static_cast<int>(shown_.size());
    shown_.push_back(n);
    const QString number = QString::number(row);
    auto* const on = new QCheckBox(rows_);
    on->setObjectName(QStringLiteral("palpateOn") + number);
    on->setToolTip(tr("Whether it is felt"));
    connect(on, &QCheckBox::clicked, this, [this, n](bool checked) {
      model_.edit(checked ? tr("Switch on %1").arg(name_of(model_.scene(), n))
                          : tr("Switch off %1").arg(name_of(model_.scene(), n)),
                  [&](modes::Scene& s) { s.modes[n].enabled = checked; });
    });
    grid_->addWidget(on, row, 0);
    auto* const color = new QToolButton(rows_);
    color->setObjectName(QStringLiteral("palpateColor") + number);
    color->setFixedSize(18, 18);
    color->setToolTip(tr("Its color, here and in the views"));
    connect(color, &QToolButton::clicked, this, [this, n] {
      const QColor chosen = QColorDialog::getColor(color_of(model_.scene().modes[n]), this, name_of(model_.scene(), n),
                                                   QColorDialog::DontUseNativeDialog);
      if (!chosen.isValid()) return;
      model_.edit(tr("Color %1").arg(name_of(model_.scene(), n)),
                  [&](modes::Scene& s) { s.modes[n].color = chosen.name().toStdString(); });
    });
    grid_->addWidget(color, row, 1);
    auto* const name = new QLineEdit(rows_);
    name->setObjectName(QStringLiteral("palpateName") + number);
    name->setFrame(false);
    connect(name, &QLineEdit::editingFinished, this, [this, n, name] {
      if (name->text() == name_of(model_.scene(), n)) return;
      model_.edit(tr("Rename %1").arg(name_of(model_.scene(), n)),
                  [&](modes::Scene& s) { s.modes[n].name = name->text().toStdString(); });
    });
    grid_->addWidget(name, row, 2);
    auto* const strength = new QDoubleSpinBox(rows_);
    strength->setObjectName(QStringLiteral("palpateStrength") + number);
    strength->setRange(0, strongest_n);
    strength->setDecimals(2);
    strength->setSingleStep(0.1);
    strength->setSuffix(tr(" N"));
    strength->setKeyboardTracking(false);
    strength->setToolTip(tr("How hard it resists before it yields"));
    connect(strength, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, [this, n](double newtons) {
      model_.edit(tr("Strength of %1").arg(name_of(model_.scene(), n)),
                  [&](modes::Scene& s) { scale_strength(s.modes[n], newtons); });
    });
    grid_->addWidget(strength, row, 3);
  }
  if (shown_.empty()) {
    auto* const none = new QLabel(tr("No boundaries yet: open a scan."), rows_);
    none->setEnabled(false);
    grid_->addWidget(none, 0, 0, 1, 4);
  }
  constexpr int most_rows = 5;
  const int row_height = shown_.empty() ? 24 : grid_->itemAtPosition(0, 3)->widget()->sizeHint().height() + 1;
  scroll_->setFixedHeight(row_height * std::clamp(static_cast<int>(shown_.size()), 1, most_rows) + 2);
  show_values();
}

void TissuesSection::show_values() {
  const modes::Scene& scene = model_.scene();
  const bool same = shown_types_.size() == scene.modes.size() &&
                    std::equal(shown_types_.begin(), shown_types_.end(), scene.modes.begin(),
                               [](const std::string& type, const modes::Mode& mode) { return type == mode.type; });
  if (!same) {
    // Not now: a row may be what brought the change.
    shown_types_.clear();
    QMetaObject::invokeMethod(
        this, [this] { build_rows(); }, Qt::QueuedConnection);
    return;
  }
  for (std::size_t row = 0; row < shown_.size(); ++row) {
    const modes::Mode& mode = scene.modes[shown_[row]];
    const QString number = QString::number(row);
    rows_->findChild<QCheckBox*>(QStringLiteral("palpateOn") + number)->setChecked(mode.enabled);
    rows_->findChild<QToolButton*>(QStringLiteral("palpateColor") + number)
        ->setStyleSheet(QStringLiteral("background: %1; border: 1px solid palette(dark)").arg(color_of(mode).name()));
    auto* const name = rows_->findChild<QLineEdit*>(QStringLiteral("palpateName") + number);
    if (!name->hasFocus() || name->text().isEmpty()) {
      name->setText(name_of(scene, shown_[row]));
      name->setCursorPosition(0);
    }
    name->setToolTip(name_of(scene, shown_[row]));
    auto* const strength = rows_->findChild<QDoubleSpinBox*>(QStringLiteral("palpateStrength") + number);
    const QSignalBlocker quiet(strength);
    strength->setValue(strength_of(mode));
  }
}

}  // namespace palpate::plugin
