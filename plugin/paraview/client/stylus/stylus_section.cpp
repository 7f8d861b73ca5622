#include "plugin/paraview/client/stylus/stylus_section.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QSettings>
#include <QSignalBlocker>
#include <QToolButton>

#include <utility>

#include "device/found_devices.h"

namespace palpate::plugin {
StylusSection::StylusSection(SessionController& touching, SceneModel& model, std::function<Eye()> eye, QWidget* parent)
    : QWidget(parent), touching_(touching), model_(model), eye_(std::move(eye)) {
  setObjectName(QStringLiteral("palpateStylus"));
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(3);
  build_connection(*this);
  build_limits();
  build_workspace();
  message_ = new QLabel(this);
  message_->setObjectName(QStringLiteral("palpateStylusMessage"));
  message_->setWordWrap(true);
  message_->setTextFormat(Qt::PlainText);
  message_->hide();
  column->addWidget(message_);
  connect(&touching, &SessionController::told, this, [this](const QString& text, bool problem) {
    message_->setText(text);
    message_->setStyleSheet(problem ? QStringLiteral("color: #b00020; font-weight: bold") : QString());
    message_->setVisible(!text.isEmpty());
  });
  connect(&touching, &SessionController::clutch_button_let_go, this, [this] { clutch(false); });
  connect(&touching, &SessionController::connection_changed, this, [this] {
    message_->hide();  // it was about what was before
    message_->clear();
    show_connection();
  });
  connect(&touching, &SessionController::looked, this, [this](const SessionStatus& look) { show_look(look); });
  connect(&model, &SceneModel::changed, this, [this](Pace) { show_scene(); });
  find_devices();
  show_connection();
}

void StylusSection::build_connection(QWidget& parent) {
  auto* const column = static_cast<QVBoxLayout*>(layout());
  auto* const row = new QHBoxLayout;
  device_ = new QComboBox(&parent);
  device_->setObjectName(QStringLiteral("palpateDevice"));
  device_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  device_->setMinimumContentsLength(10);
  connect(device_, QOverload<int>::of(&QComboBox::activated), this, [this] { show_choice(); });
  row->addWidget(device_, 1);
  auto* const look = new QToolButton(&parent);
  look->setObjectName(QStringLiteral("palpateFindDevices"));
  look->setText(QStringLiteral("⟳"));
  look->setToolTip(tr("Look for styluses again"));
  connect(look, &QToolButton::clicked, this, [this] { find_devices(); });
  row->addWidget(look);
  connect_ = new QPushButton(tr("Connect"), &parent);
  connect_->setObjectName(QStringLiteral("palpateConnect"));
  connect(connect_, &QPushButton::clicked, this, [this] { connect_or_not(); });
  row->addWidget(connect_);
  column->addLayout(row);
  file_ = new QLineEdit(&parent);
  file_->setObjectName(QStringLiteral("palpateDeviceFile"));
  file_->hide();
  column->addWidget(file_);
}

void StylusSection::build_limits() {
  auto* const grid = new QGridLayout;
  grid->setHorizontalSpacing(4);
  grid->setVerticalSpacing(1);
  const auto add = [&](int row, const char* name, const QString& label, const QString& suffix, double low, double high,
                       double step, auto set) {
    auto* const box = new QDoubleSpinBox(this);
    box->setObjectName(QString::fromLatin1(name));
    box->setRange(low, high);
    box->setSingleStep(step);
    box->setDecimals(step < 1 ? 1 : 0);
    box->setSuffix(suffix);
    box->setKeyboardTracking(false);
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
            [this, label, set](double value) { model_.edit(label, [&](modes::Scene& s) { set(s, value); }); });
    grid->addWidget(new QLabel(label, this), row, 0);
    grid->addWidget(box, row, 1);
    return box;
  };
  stiffness_ = add(0, "palpateStiffness", tr("Stiffness"), tr(" N/m"), 50, 5000, 50,
                   [](modes::Scene& s, double value) { s.stiffness_n_per_m = value; });
  limit_ = add(1, "palpateForceLimit", tr("Force limit"), tr(" N"), 0.1, 20, 0.1,
               [](modes::Scene& s, double value) { s.limits.force_n = value; });
  own_ = new QLabel(this);
  own_->setObjectName(QStringLiteral("palpateOwnLimits"));
  own_->setWordWrap(true);
  grid->addWidget(own_, 0, 2, 2, 1);
  grid->setColumnStretch(2, 1);
  static_cast<QVBoxLayout*>(layout())->addLayout(grid);
}

void StylusSection::build_workspace() {
  auto* const column = static_cast<QVBoxLayout*>(layout());
  auto* const row = new QHBoxLayout;
  row->setSpacing(3);
  row->addWidget(new QLabel(tr("Reach"), this));
  const auto add = [&](std::size_t n, const char* name, const QString& text, const QString& tip, auto settings) {
    auto* const button = new QToolButton(this);
    button->setObjectName(QString::fromLatin1(name));
    button->setText(text);
    button->setToolTip(tip);
    connect(button, &QToolButton::clicked, this, [this, text, settings] { remap(text, settings()); });
    row->addWidget(button);
    fits_[n] = button;
  };
  add(0, "palpateFitScan", tr("Scan"), tr("The whole scan is in the stylus' reach."),
      [this] { return fit_scan(model_.scene().workspace); });
  add(1, "palpateFitView", tr("View"), tr("What the 3D view shows is in reach, turned as the view is."), [this] {
    const bool held = touching_.live().is_connected();
    const device::Specification stylus =
        held ? touching_.live().specification() : device::SimulatedStylus().specification();
    return fit_view(eye_(), stylus.workspace_half_extent);
  });
  add(2, "palpateOneToOne", tr("1:1"), tr("A millimeter of the patient for each of the hand."),
      [this] { return one_to_one(touching_.live().plan() ? touching_.live().plan()->workspace : modes::Workspace{}); });
  row->addStretch(1);
  clutch_ = new QPushButton(tr("Clutch"), this);
  clutch_->setObjectName(QStringLiteral("palpateClutch"));
  clutch_->setCheckable(true);
  clutch_->setToolTip(
      tr("While it is down, hand and patient are parted: move the hand to a better place, or turn the view. "
         "The stylus' first button does the same."));
  connect(clutch_, &QPushButton::clicked, this, [this](bool on) { clutch(on); });
  row->addWidget(clutch_);
  column->addLayout(row);
  scale_ = new QLabel(this);
  scale_->setObjectName(QStringLiteral("palpateScale"));
  column->addWidget(scale_);
  turn_ = new QCheckBox(tr("Clutch turns it with the view"), this);
  turn_->setObjectName(QStringLiteral("palpateTurn"));
  turn_->setToolTip(tr("After clutching, to the right in the hand is to the right in the 3D view."));
  follow_ = new QCheckBox(tr("Slices follow"), this);
  follow_->setObjectName(QStringLiteral("palpateFollow"));
  follow_->setToolTip(tr("The slices through the proxy are shown as it moves."));
  follow_->setChecked(true);
  connect(follow_, &QCheckBox::toggled, this, [this](bool on) {
    if (on) go_to_stylus();
  });
  go_ = new QToolButton(this);
  go_->setObjectName(QStringLiteral("palpateGoToStylus"));
  go_->setText(tr("Go to stylus"));
  go_->setToolTip(tr("Shows the slices through the stylus. They follow it again after you have leafed through them."));
  connect(go_, &QToolButton::clicked, this, [this] { go_to_stylus(); });
  auto* const ticks = new QHBoxLayout;
  ticks->addWidget(follow_);
  ticks->addWidget(go_);
  ticks->addStretch(1);
  column->addLayout(ticks);
  column->addWidget(turn_);
}

bool StylusSection::slices_follow() const {
  return follow_->isChecked() && !leafing_;
}

void StylusSection::pause_following() {
  leafing_ = true;
}

void StylusSection::go_to_stylus() {
  leafing_ = false;
  emit stylus_wanted();
}

void StylusSection::find_devices() {
  device_->clear();
  device_->addItem(tr("Simulated (mouse and keyboard)"), QStringLiteral("simulated"));
  for (const device::FoundDevice& found : device::find_devices()) {
    const QString kind = QString::fromStdString(found.kind);
    const QString address = QString::fromStdString(found.address);
    device_->addItem(QString::fromStdString(found.name) + (found.accessible ? QString() : tr(" (no permission)")),
                     address.isEmpty() ? kind : kind + QLatin1Char('@') + address);
    device_->setItemData(device_->count() - 1, QString::fromStdString(found.note), Qt::ToolTipRole);
  }
  show_choice();
}

void StylusSection::show_choice() {
  const QString kind = device_->currentData().toString().section(QLatin1Char('@'), 0, 0);
  file_->setVisible(kind == QLatin1String("falcon") || kind == QLatin1String("wooden_haptics"));
  file_->setPlaceholderText(kind == QLatin1String("falcon") ? tr("Novint's firmware file, if it was switched off")
                                                            : tr("The arm's geometry: a JSON file"));
  file_->setText(QSettings().value(QStringLiteral("palpate/file/") + kind).toString());
}

void StylusSection::connect_or_not() {
  if (touching_.live().is_connected()) {
    touching_.disconnect_stylus();
    return;
  }
  const QString device = device_->currentData().toString();
  const QString kind = device.section(QLatin1Char('@'), 0, 0);
  if (file_->isVisible()) QSettings().setValue(QStringLiteral("palpate/file/") + kind, file_->text());
  const std::string file = file_->text().toStdString();
  touching_.connect_stylus({.device = device.toStdString(),
                            .firmware = kind == QLatin1String("falcon") ? file : std::string(),
                            .settings = kind == QLatin1String("wooden_haptics") ? file : std::string()});
  if (static bool said = false;
      touching_.live().is_connected() && message_->text().isEmpty() && !std::exchange(said, true)) {
    message_->setText(
        tr("Research software, not a medical device: it must not guide a diagnosis or a treatment. "
           "Esc takes the force away at any time."));
    message_->setStyleSheet({});
    message_->show();
  }
}

void StylusSection::show_connection() {
  const LiveSession& live = touching_.live();
  const bool held = live.is_connected();
  connect_->setText(held ? tr("Disconnect") : tr("Connect"));
  connect_->setEnabled(held || live.scan() != nullptr || !touching_.why_no_scan().isEmpty());
  connect_->setToolTip(live.scan() ? QString() : tr("Open a scan first."));
  device_->setEnabled(!held);
  file_->setEnabled(!held);
  clutch_->setEnabled(held);
  leafing_ = false;  // whoever takes the stylus wants to see it
  if (held) {
    const device::Specification& stylus = live.specification();
    own_->setText(stylus.force_axes > 0 ? tr("its own: %1 N/m, %2 N (%3 N for long)")
                                              .arg(stylus.stiffness_limit, 0, 'f', 0)
                                              .arg(stylus.maximum_force, 0, 'f', 1)
                                              .arg(stylus.continuous_force, 0, 'f', 1)
                                        : tr("it gives no force"));
  } else {
    own_->setText({});
  }
  show_scene();
  emit connection_shown(held, connect_->isEnabled());
}

void StylusSection::show_scene() {
  const modes::Scene& scene = model_.scene();
  const QSignalBlocker quiet(stiffness_), quiet_too(limit_);
  stiffness_->setValue(scene.stiffness_n_per_m);
  limit_->setValue(scene.limits.force_n);
  const auto plan = touching_.live().plan();
  scale_->setText(plan ? tr("%1 mm of patient per mm of hand").arg(plan->workspace.mm_per_m / 1e3, 0, 'f', 2)
                       : tr("no scan yet"));
}

void StylusSection::show_look(const SessionStatus& look) {
  clutch_->setChecked(look.clutched);
  const bool may = touching_.may_remap();
  for (QToolButton* const fit : fits_) fit->setEnabled(may);
  go_->setEnabled(look.is_seen());
}

void StylusSection::remap(const QString& what, const modes::WorkspaceSettings& settings) {
  if (!touching_.may_remap()) return;
  model_.edit(tr("Reach: %1").arg(what), [&](modes::Scene& s) { s.workspace = settings; });
}

void StylusSection::clutch(bool on) {
  if (on) {
    touching_.clutch();
  } else {
    touching_.unclutch(turn_->isChecked() ? rotation_of(eye_()) : touching_.last().workspace.rotation);
  }
}

}  // namespace palpate::plugin
