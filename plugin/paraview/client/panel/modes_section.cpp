#include "plugin/paraview/client/panel/modes_section.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QListWidget>
#include <QMenu>
#include <QPointer>
#include <QSignalBlocker>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>

#include "modes/types/mode_type.h"
#include "plugin/paraview/client/model/shown_mode.h"
#include "plugin/paraview/client/panel/tissues_section.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/words/mode_words.h"

namespace palpate::plugin {
namespace {

QString text(std::string_view utf8) {
  return QString::fromUtf8(utf8.data(), static_cast<int>(utf8.size()));
}

/// A name that no other mode of the scene has.
std::string new_name(const modes::Scene& scene, const std::string& type) {
  std::string name = type;
  for (int n = 2; std::any_of(scene.modes.begin(), scene.modes.end(), [&](const auto& m) { return m.name == name; });
       ++n) {
    name = type + " " + std::to_string(n);
  }
  return name;
}

constexpr double first_strength_n = 0.3;

}  // namespace

ModesSection::ModesSection(SceneModel& model, SessionController& session, QWidget* parent)
    : QWidget(parent), model_(model), session_(session) {
  setObjectName(QStringLiteral("palpateModes"));
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(3);
  list_ = new QListWidget(this);
  list_->setObjectName(QStringLiteral("palpateModeList"));
  list_->setMaximumHeight(110);
  connect(list_, &QListWidget::currentRowChanged, this, [this] { show_mode(); });
  connect(list_, &QListWidget::itemChanged, this, [this](QListWidgetItem* item) {
    if (listing_) return;
    const auto n = static_cast<std::size_t>(list_->row(item));
    const bool on = item->checkState() == Qt::Checked;
    model_.edit_mode(
        on ? tr("Switch on %1").arg(item->text()) : tr("Switch off %1").arg(item->text()), n,
        [on](modes::Mode& mode) { mode.enabled = on; }, told());
  });
  column->addWidget(list_);
  auto* const row = new QHBoxLayout;
  auto* const add = new QToolButton(this);
  add->setObjectName(QStringLiteral("palpateAddMode"));
  add->setText(tr("Add"));
  add->setPopupMode(QToolButton::InstantPopup);
  auto* const menu = new QMenu(add);
  for (const modes::ModeType* const type : modes::mode_types()) {
    QAction* const action = menu->addAction(tr("%1: %2").arg(text(type->name), text(type->summary)));
    action->setObjectName(QStringLiteral("palpateAdd_") + text(type->name));
    connect(action, &QAction::triggered, this, [this, type] { add_mode(std::string(type->name)); });
    if (!modes::contains(type->keys, modes::Key::margin)) continue;
    connect(menu, &QMenu::aboutToShow, action,
            [this, action] { action->setEnabled(!model_.scene().structures.empty()); });
  }
  add->setMenu(menu);
  row->addWidget(add);
  auto* const remove = new QToolButton(this);
  remove->setObjectName(QStringLiteral("palpateRemoveMode"));
  remove->setText(tr("Remove"));
  connect(remove, &QToolButton::clicked, this, [this] { remove_mode(); });
  row->addWidget(remove);
  row->addStretch(1);
  column->addLayout(row);
  auto* const parameters = new QWidget(this);
  build_parameters(*parameters);
  column->addWidget(parameters);
  plan_ = make_message_label(*this, "palpatePlan");
  plan_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  column->addWidget(plan_);
  message_ = make_message_label(*this, "palpateModesMessage");
  message_->hide();
  column->addWidget(message_);
  connect(&model, &SceneModel::changed, this, [this](Pace) {
    message_->hide();
    list_modes();
  });
  list_modes();
}

SceneModel::Told ModesSection::told() {
  return [alive = QPointer(this)](const QString& why) {
    if (!alive || why.isEmpty()) return;
    show_message(*alive->message_, why, true);
    alive->list_modes();
  };
}

void ModesSection::build_parameters(QWidget& parent) {
  auto* const form = new QFormLayout(&parent);
  form->setContentsMargins(0, 0, 0, 0);
  form->setVerticalSpacing(2);
  summary_ = new QLabel(&parent);
  summary_->setWordWrap(true);
  form->addRow(summary_);
  const auto add_box = [&](const char* name, const QString& label, const QStringList& items, auto act) {
    auto* const box = new QComboBox(&parent);
    box->setObjectName(QString::fromLatin1(name));
    box->addItems(items);
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    box->setMinimumContentsLength(10);
    connect(box, QOverload<int>::of(&QComboBox::activated), this, act);
    form->addRow(label, box);
    return box;
  };
  strength_ = new QDoubleSpinBox(&parent);
  strength_->setObjectName(QStringLiteral("palpateModeStrength"));
  strength_->setRange(0, 20);
  strength_->setSingleStep(0.05);
  strength_->setSuffix(tr(" N"));
  strength_->setKeyboardTracking(false);
  connect(strength_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
          [this](double newtons) { set(tr("Strength"), [newtons](modes::Mode& m) { scale_strength(m, newtons); }); });
  form->addRow(tr("Strength"), strength_);
  side_ = add_box("palpateSide", tr("Resists"),
                  {tr("entering (towards higher values)"), tr("leaving (towards lower values)"), tr("both")},
                  [this](int n) { set(tr("Side"), [n](modes::Mode& m) { m.side = static_cast<modes::Side>(n); }); });
  const auto set_tissue = [this](QComboBox* box, std::string modes::Mode::*end) {
    const std::string tissue = box->currentIndex() == 0 ? std::string() : box->currentText().toStdString();
    set(tr("Tissues"), [tissue, end](modes::Mode& m) {
      m.*end = tissue;
      if (m.from.empty() != m.to.empty()) m.from.empty() ? m.from = m.to : m.to = m.from;
    });
  };
  from_ = add_box("palpateFrom", tr("From"), {}, [this, set_tissue](int) { set_tissue(from_, &modes::Mode::from); });
  to_ = add_box("palpateTo", tr("To"), {}, [this, set_tissue](int) { set_tissue(to_, &modes::Mode::to); });
  direction_ =
      add_box("palpateDirection", tr("Direction"), {tr("the vector field"), tr("the gradient")}, [this](int n) {
        set(tr("Direction"), [n](modes::Mode& m) { m.direction_of = static_cast<modes::DirectionField>(n); });
      });
  shape_ = add_box("palpateShape", tr("Shape"), {tr("point"), tr("line"), tr("plane")}, [this](int n) {
    set(tr("Shape"), [n](modes::Mode& m) { m.shape = static_cast<modes::Shape>(n); });
  });
  here_ = new QToolButton(&parent);
  here_->setObjectName(QStringLiteral("palpateHere"));
  here_->setText(tr("Put the landmark where the proxy is"));
  connect(here_, &QToolButton::clicked, this,
          [this] { set(tr("Place"), [at = session_.last().proxy_mm](modes::Mode& m) { m.position_mm = at; }); });
  form->addRow(tr("Place"), here_);
}

std::size_t ModesSection::mode() const {
  return list_->currentRow() < 0 ? modes::Scene::most_modes : static_cast<std::size_t>(list_->currentRow());
}

void ModesSection::set(const QString& what, const std::function<void(modes::Mode&)>& change) {
  const std::size_t n = mode();
  if (n >= model_.scene().modes.size()) return;
  model_.edit_mode(tr("%1 of %2").arg(what, name_of(model_.scene(), n)), n, change, told());
}

void ModesSection::add_mode(const std::string& type) {
  const glm::dvec3 here = session_.last().proxy_mm;
  model_.edit(
      tr("Add %1").arg(QString::fromStdString(type)),
      [type, here](modes::Scene& scene) {
        modes::Mode mode;
        mode.type = type;
        mode.name = new_name(scene, type);
        mode.strength_of = modes::find_mode_type(type)->strength_of;
        mode.strength_n = modes::TransferFunction(first_strength_n);
        mode.position_mm = here;
        if (modes::contains(modes::find_mode_type(type)->keys, modes::Key::margin)) {
          mode.structure = scene.structures.front().name;
        }
        scene.modes.push_back(mode);
      },
      told());
  list_->setCurrentRow(list_->count() - 1);
}

void ModesSection::remove_mode() {
  const std::size_t n = mode();
  if (n >= model_.scene().modes.size()) return;
  model_.edit(
      tr("Remove %1").arg(name_of(model_.scene(), n)),
      [shown = ShownMode(model_, n)](modes::Scene& scene) {
        scene.modes.erase(scene.modes.begin() + static_cast<std::ptrdiff_t>(shown.in(scene)));
      },
      told());
}

void ModesSection::list_modes() {
  listing_ = true;
  const modes::Scene& scene = model_.scene();
  const int was = list_->currentRow();
  while (list_->count() > static_cast<int>(scene.modes.size())) delete list_->takeItem(list_->count() - 1);
  for (std::size_t n = 0; n < scene.modes.size(); ++n) {
    const int row = static_cast<int>(n);
    if (row >= list_->count()) list_->addItem(QString());
    QListWidgetItem& item = *list_->item(row);
    item.setText(tr("%1 (%2)").arg(name_of(scene, n), QString::fromStdString(scene.modes[n].type)));
    item.setFlags(item.flags() | Qt::ItemIsUserCheckable);
    item.setCheckState(scene.modes[n].enabled ? Qt::Checked : Qt::Unchecked);
  }
  list_->setCurrentRow(std::clamp(was, list_->count() > 0 ? 0 : -1, list_->count() - 1));
  listing_ = false;
  show_mode();
  refresh();
}

void ModesSection::show_mode() {
  const modes::Scene& scene = model_.scene();
  const std::size_t n = mode();
  const bool any = n < scene.modes.size();
  const modes::ModeType* const type = any ? modes::find_mode_type(scene.modes[n].type) : nullptr;
  const auto reads = [&](modes::Key key) { return type && modes::contains(type->keys, key); };
  auto* const form = static_cast<QFormLayout*>(summary_->parentWidget()->layout());
  const auto show_row = [&](QWidget* field, bool visible) {
    field->setVisible(visible);
    if (QWidget* const label = form->labelForField(field)) label->setVisible(visible);
  };
  const modes::Mode shown = any ? scene.modes[n] : modes::Mode{};
  const bool pair = reads(modes::Key::tissues) && !scene.tissues.empty();
  summary_->setVisible(type != nullptr);
  if (type) summary_->setText(text(type->summary));
  show_row(strength_, reads(modes::Key::strength));
  show_row(side_, reads(modes::Key::side) && shown.from.empty());
  show_row(from_, pair);
  show_row(to_, pair);
  show_row(direction_, reads(modes::Key::direction_of));
  show_row(shape_, reads(modes::Key::landmark));
  show_row(here_, reads(modes::Key::landmark));
  if (!any) return;
  const QSignalBlocker quiet(strength_);
  strength_->setValue(strength_of(shown));
  side_->setCurrentIndex(static_cast<int>(shown.side));
  direction_->setCurrentIndex(static_cast<int>(shown.direction_of));
  shape_->setCurrentIndex(static_cast<int>(shown.shape));
  for (const auto& [box, end] : {std::pair{from_, shown.from}, std::pair{to_, shown.to}}) {
    box->clear();
    box->addItem(tr("(any)"));
    for (const modes::Tissue& tissue : scene.tissues) box->addItem(QString::fromStdString(tissue.name));
    box->setCurrentIndex(std::max(0, box->findText(QString::fromStdString(end))));
  }
}

void ModesSection::show_technical(bool shown) {
  plan_->setVisible(shown);
}

void ModesSection::refresh() {
  const auto plan = session_.live().plan();
  if (!plan) {
    plan_->setText({});
    return;
  }
  QStringList lines;
  for (const modes::LeftOut& left : plan->left_out) {
    lines << tr("%1: %2 (saves %3)")
                 .arg(QString::fromStdString(left.what), QString::fromStdString(left.why),
                      QString::fromStdString(left.saves));
  }
  plan_->setText(lines.isEmpty()
                     ? tr("Everything is needed; nothing was left out.")
                     : tr("Left out, because nothing here needs it:\n• %1").arg(lines.join(QStringLiteral("\n• "))));
}

}  // namespace palpate::plugin
