#include "plugin/paraview/client/panel/tissues_section.h"

#include <QComboBox>
#include <QFile>
#include <QFileDialog>
#include <QFileInfo>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPointer>
#include <QSaveFile>
#include <QSignalBlocker>

#include <algorithm>
#include <exception>
#include <vector>

#include "modes/scene/scene_json.h"
#include "modes/scene/starting_scene.h"
#include "modes/types/mode_type.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/panel/force_difference.h"
#include "plugin/paraview/client/widgets/file_name.h"
#include "plugin/paraview/client/widgets/tool_button.h"
#include "plugin/paraview/client/words.h"
#include "plugin/paraview/client/words/mode_words.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {
namespace {

/// How the hand reaches the scan and is protected is the user's, whichever scene is felt.
modes::Scene with_hand_of(modes::Scene scene, const modes::Scene& now) {
  scene.workspace = now.workspace;
  scene.limits = now.limits;
  scene.stiffness_n_per_m = now.stiffness_n_per_m;
  return scene;
}

/// The felt part of a scene, to distinguish scenes.
std::string text_of(const modes::Scene& scene) {
  return modes::to_json(with_hand_of(scene, {}));
}

/// The properties of a mode that the rows depend on.
std::string kind_of(const modes::Mode& mode) {
  return mode.type + '\n' + mode.from + '\n' + mode.to;
}

}  // namespace

TissuesSection::TissuesSection(SceneModel& model, QWidget* parent) : QWidget(parent), model_(model) {
  setObjectName(QStringLiteral("palpateTissues"));
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(3);
  auto* const top = new QHBoxLayout;
  scenes_ = new QComboBox(this);
  scenes_->setObjectName(QStringLiteral("palpateScenes"));
  scenes_->setToolTip(
      tr("A scene defines which boundaries are felt. The first in the list is the one found in this scan."));
  choices_.push_back({tr("Found in this scan"), {}, {}});
  for (const std::string& name : modes::starting_scenes()) {
    const modes::Scene scene = modes::load_scene(name);
    add_choice(QString::fromStdString(scene.name), scene);
    choices_.back().name = name;
  }
  list_choices();
  show_origin();
  connect(scenes_, QOverload<int>::of(&QComboBox::activated), this, [this](int index) { choose_scene(index); });
  scenes_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  scenes_->setMinimumContentsLength(10);
  top->addWidget(scenes_, 1);
  add_tool_button(*top, *this, "palpateOpenScene", tr("Open…"), tr("Opens a scene from a file"),
                  [this] { open_file(); });
  add_tool_button(*top, *this, "palpateSaveScene", tr("Save…"), tr("Saves this scene to a file"),
                  [this] { save_file(); });
  column->addLayout(top);
  rows_ = new QWidget(this);
  rows_->setObjectName(QStringLiteral("palpateBoundaries"));
  column->addWidget(rows_);  // in the panel's own scrolled column: no second one within it
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

void TissuesSection::set_proposed(const std::optional<modes::Scene>& scene) {
  if (scene) {
    choices_.front().scene = *scene;
    choices_.front().text = text_of(*scene);
    for (const int role : {Qt::ToolTipRole, Qt::ForegroundRole}) scenes_->setItemData(0, {}, role);
  } else {
    scenes_->setItemData(0, tr("No boundaries were found in this scan."), Qt::ToolTipRole);
    scenes_->setItemData(0, palette().color(QPalette::Disabled, QPalette::Text), Qt::ForegroundRole);
  }
  follow_origin();
}

void TissuesSection::forget_scan(const ScanHandle& shown) {
  choices_.front() = {tr("Found in this scan"), {}, {}};
  const auto offered = modes::offered_scenes(shown.scene, shown.volume->modality, shown.volume->vectors != nullptr);
  const auto suiting = std::ranges::count_if(offered, &std::string::empty, &modes::OfferedScene::made_for);
  std::map<QString, double> places;  // of a choice: files that were opened come before what does not suit the scan
  for (Choice& choice : choices_) {
    const auto as = std::ranges::find(offered, choice.name, &modes::OfferedScene::name);
    const bool starting = as != offered.end();
    choice.made_for = starting ? QString::fromStdString(as->made_for) : QString();
    places[choice.label] = starting ? static_cast<double>(as - offered.begin()) : static_cast<double>(suiting) - 0.5;
  }
  std::stable_sort(choices_.begin() + 1, choices_.end(), [&](const Choice& one, const Choice& other) {
    return places.at(one.label) < places.at(other.label);
  });
  choice_ = 0;
  edited_from_.clear();
  list_choices();
  follow_origin();
}

/// The box has an item for each, in their order.
void TissuesSection::list_choices() {
  const QSignalBlocker quiet(scenes_);
  scenes_->clear();
  for (const Choice& choice : choices_) {
    scenes_->addItem(choice.label);
    if (choice.made_for.isEmpty()) continue;
    const int item = scenes_->count() - 1;
    scenes_->setItemData(item, tr("Made for %1. This scan is of another kind.").arg(choice.made_for), Qt::ToolTipRole);
    scenes_->setItemData(item, palette().color(QPalette::Disabled, QPalette::Text), Qt::ForegroundRole);
  }
}

void TissuesSection::set_restored() {
  choice_ = add_choice(tr("Restored from the state file"), model_.scene());
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
    same->scene = scene;
    same->text = text_of(scene);
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
  model_.edit(
      what,
      [alive = QPointer(this), item, chosen = choices_[static_cast<std::size_t>(item)].scene](modes::Scene& scene) {
        scene = with_hand_of(chosen, scene);
        if (alive) alive->choosing_ = item;
      },
      [alive = QPointer(this)](const QString& why) {
        if (!alive) return;
        alive->choosing_.reset();
        why.isEmpty() ? emit alive->scene_kept() : emit alive->model_.refused(why);
      });
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
  const QString name = ask_file_to_write(this, tr("Save scene"), tr("Scenes (*.json)"), QStringLiteral("json"),
                                         QStringLiteral("scene.json"));
  if (name.isEmpty()) return;
  QSaveFile file(name);
  modes::Scene kept = model_.scene();
  snap_no_more(kept);  // a correction that is running is no part of it
  const std::string text = modes::to_json(kept);
  const auto size = static_cast<qint64>(text.size());
  if (!file.open(QIODevice::WriteOnly) || file.write(text.data(), size) != size || !file.commit()) {
    emit model_.refused(words(say("panel-cannot-write", name.toStdString(), file.errorString().toStdString())));
    return;
  }
  emit scene_kept();
}

void TissuesSection::build_rows() {
  boundaries_.clear();
  delete grid_;
  qDeleteAll(rows_->findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly));
  grid_ = new QGridLayout(rows_);
  grid_->setContentsMargins(0, 0, 0, 0);
  grid_->setHorizontalSpacing(4);
  grid_->setVerticalSpacing(1);
  grid_->setColumnStretch(BoundaryRow::name_column, 1);
  const modes::Scene& scene = model_.scene();
  shown_types_.clear();
  for (const modes::Mode& mode : scene.modes) shown_types_.push_back(kind_of(mode));
  // Where it has no boundaries, as in a flow, whatever else it has.
  const auto is_boundary = [](const modes::Mode& mode) {
    return modes::reads_key(mode, modes::Key::tissues) || modes::reads_key(mode, modes::Key::margin);
  };
  const bool any_surface = std::ranges::any_of(scene.modes, is_boundary);
  std::vector<bool> has_row(scene.modes.size(), false);
  for (std::size_t n = 0; n < scene.modes.size(); ++n) {
    if (has_row[n] || (any_surface && !is_boundary(scene.modes[n]))) continue;
    if (const auto back = way_back_of(scene, n)) has_row[*back] = true;
    boundaries_.push_back(
        std::make_unique<BoundaryRow>(model_, n, static_cast<int>(boundaries_.size()), *rows_, *grid_));
  }
  if (boundaries_.empty()) {
    auto* const none = new QLabel(tr("No boundaries yet: open a scan."), rows_);
    none->setEnabled(false);
    grid_->addWidget(none, 0, 0, 1, BoundaryRow::columns);
  }
  show_values();
}

void TissuesSection::show_values() {
  const modes::Scene& scene = model_.scene();
  const bool same = shown_types_.size() == scene.modes.size() &&
                    std::equal(shown_types_.begin(), shown_types_.end(), scene.modes.begin(),
                               [](const std::string& type, const modes::Mode& mode) { return type == kind_of(mode); });
  if (!same) {
    // Not now: a row may be what brought the change.
    shown_types_.clear();
    QMetaObject::invokeMethod(
        this, [this] { build_rows(); }, Qt::QueuedConnection);
    return;
  }
  for (const auto& boundary : boundaries_) boundary->show_values();
  show_alike();
}

/// Marks pairs of felt boundaries whose strengths are too similar to be distinguished.
void TissuesSection::show_alike() {
  const modes::Scene& scene = model_.scene();
  for (const auto& one : boundaries_) {
    QStringList like;
    for (const auto& other : boundaries_) {
      const bool both = other != one && one->is_felt() && other->is_felt();
      const double strength_n = strength_of(scene.modes[other->mode()]);
      if (both && feels_alike(strength_of(scene.modes[one->mode()]), strength_n)) {
        like << name_of(scene, other->mode());
      }
    }
    one->set_alike(like);
  }
}

}  // namespace palpate::plugin
