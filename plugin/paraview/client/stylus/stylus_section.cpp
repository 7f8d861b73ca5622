#include "plugin/paraview/client/stylus/stylus_section.h"

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPointer>
#include <QPushButton>
#include <QSettings>
#include <QSignalBlocker>
#include <QToolButton>

#include <algorithm>
#include <string_view>
#include <utility>

#include "device/device_type.h"
#include "device/safety/guardian.h"

#include "plugin/paraview/client/widgets/kept_width.h"
#include "plugin/paraview/client/widgets/message_label.h"

namespace palpate::plugin {
namespace {

QString in_qt(std::string_view text) {
  return QString::fromUtf8(text.data(), static_cast<int>(text.size()));
}

}  // namespace

StylusSection::StylusSection(SessionController& session, SceneModel& model, std::function<Eye()> eye, QWidget* parent)
    : QWidget(parent), session_(session), model_(model), eye_(std::move(eye)) {
  setObjectName(QStringLiteral("palpateStylus"));
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(3);
  build_connection(*this);
  build_limits();
  build_workspace();
  message_ = make_message_label(*this, "palpateStylusMessage");
  message_->hide();
  column->addWidget(message_);
  connect(&session, &SessionController::told, this,
          [this](const QString& text, bool problem) { show_message(*message_, text, problem); });
  connect(&session, &SessionController::clutch_button_let_go, this, [this] { clutch(false); });
  connect(&session, &SessionController::connection_changed, this, [this] {
    message_->hide();  // it was about what was before
    message_->clear();
    show_connection();
  });
  connect(&session, &SessionController::polled, this, [this](const SessionStatus& look) { show_look(look); });
  connect(&model, &SceneModel::changed, this, [this](Pace) { show_scene(); });
  connect(&watch_, &DeviceWatch::found, this, [this](const auto& found) { show_devices(found); });
  show_devices({});
  watch_.look();
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
  connect(look, &QToolButton::clicked, this, [this] { watch_.look(); });
  row->addWidget(look);
  connect_ = new QPushButton(tr("Connect"), &parent);
  connect_->setObjectName(QStringLiteral("palpateConnect"));
  keep_width(*connect_, {tr("Connect"), tr("Disconnect")});
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
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, [this, label, set](double value) {
      model_.edit(
          label, [set, value](modes::Scene& s) { set(s, value); }, told());
    });
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
  add(1, "palpateFitView", tr("View"),
      tr("The workspace of the stylus covers what the 3D view shows, and is rotated like the view."), [this] {
        const bool held = session_.live().is_connected();
        const device::Specification stylus =
            held ? session_.live().specification() : device::SimulatedStylus().specification();
        return fit_view(eye_(), stylus.workspace_half_extent);
      });
  add(2, "palpateOneToOne", tr("1:1"), tr("1 mm of the hand is 1 mm in the patient."),
      [this] { return one_to_one(session_.live().plan() ? session_.live().plan()->workspace : modes::Workspace{}); });
  row->addStretch(1);
  clutch_ = new QPushButton(tr("Clutch"), this);
  clutch_->setObjectName(QStringLiteral("palpateClutch"));
  clutch_->setCheckable(true);
  clutch_->setToolTip(
      tr("While it is pressed, the hand moves and the stylus stays where it is in the patient: move the hand to a "
         "better place, or turn the view. The stylus' first button does the same."));
  connect(clutch_, &QPushButton::clicked, this, [this](bool on) { clutch(on); });
  row->addWidget(clutch_);
  column->addLayout(row);
  scale_ = new QLabel(this);
  scale_->setObjectName(QStringLiteral("palpateScale"));
  column->addWidget(scale_);
  turn_ = new QCheckBox(tr("Align the stylus with the view after clutching"), this);
  turn_->setObjectName(QStringLiteral("palpateTurn"));
  turn_->setToolTip(tr("After clutching, moving the hand to the right moves the stylus to the right in the 3D view."));
  follow_ = new QCheckBox(tr("Slices follow"), this);
  follow_->setObjectName(QStringLiteral("palpateFollow"));
  follow_->setToolTip(tr("While the proxy moves, the views show the slices through it."));
  follow_->setChecked(true);
  connect(follow_, &QCheckBox::toggled, this, [this](bool on) {
    if (on) go_to_stylus();
  });
  go_ = new QToolButton(this);
  go_->setObjectName(QStringLiteral("palpateGoToStylus"));
  go_->setText(tr("Go to stylus"));
  go_->setToolTip(tr("Shows the slices through the stylus. From then on they follow it again."));
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

void StylusSection::show_devices(const std::vector<device::FoundDevice>& found) {
  // The choice stays when devices are plugged in or out: the unplugged one may be connected.
  const QVariant chosen = device_->currentData();
  const QString chosen_text = device_->currentText();
  const QSignalBlocker quiet(device_);
  device_->clear();
  device_->addItem(tr("Simulated (mouse and keyboard)"), QStringLiteral("simulated"));
  for (const device::FoundDevice& one : found) {
    const QString kind = QString::fromStdString(one.kind);
    const QString address = QString::fromStdString(one.address);
    device_->addItem(QString::fromStdString(one.name) + (one.accessible ? QString() : tr(" (no permission)")),
                     address.isEmpty() ? kind : kind + QLatin1Char('@') + address);
    const device::DeviceType* const type = device::find_device_type(one.kind);
    const QString tested = type == nullptr ? QString() : in_qt(type->tested);
    device_->setItemData(device_->count() - 1,
                         (tested + QLatin1Char('\n') + QString::fromStdString(one.note)).trimmed(), Qt::ToolTipRole);
  }
  int at = chosen.isValid() ? device_->findData(chosen) : 0;
  if (at < 0 && session_.live().is_connected()) {
    device_->addItem(chosen_text, chosen);
    at = device_->count() - 1;
  }
  device_->setCurrentIndex(std::max(at, 0));
  if (device_->currentData() != chosen || device_->toolTip() != device_->currentText()) show_choice();
}

void StylusSection::show_choice() {
  device_->setToolTip(device_->currentText());  // the box is too narrow for some
  const QString kind = device_->currentData().toString().section(QLatin1Char('@'), 0, 0);
  const device::DeviceType* const type = device::find_device_type(kind.toStdString());
  file_->setVisible(type != nullptr && type->file != device::DeviceFile::none);
  file_->setPlaceholderText(type == nullptr ? QString() : in_qt(type->file_hint));
  file_->setText(QSettings().value(QStringLiteral("palpate/file/") + kind).toString());
}

void StylusSection::connect_or_not() {
  if (session_.live().is_connected()) {
    session_.disconnect_stylus();
    return;
  }
  const QString device = device_->currentData().toString();
  const QString kind = device.section(QLatin1Char('@'), 0, 0);
  if (file_->isVisible()) QSettings().setValue(QStringLiteral("palpate/file/") + kind, file_->text());
  const device::DeviceType* const type = device::find_device_type(kind.toStdString());
  const bool takes_file = type != nullptr && type->file != device::DeviceFile::none;
  const std::string file = takes_file ? file_->text().trimmed().toStdString() : std::string();
  // A Falcon has two files: its settings can name the firmware.
  const bool is_firmware = takes_file && type->file == device::DeviceFile::firmware &&
                           !file_->text().trimmed().endsWith(QLatin1String(".json"), Qt::CaseInsensitive);
  session_.connect_stylus({.device = device.toStdString(),
                           .firmware = is_firmware ? file : std::string(),
                           .settings = is_firmware ? std::string() : file});
  if (static bool said = false;
      session_.live().is_connected() && message_->text().isEmpty() && !std::exchange(said, true)) {
    message_->setText(
        tr("Research software, not a medical device: it must not guide a diagnosis or a treatment. "
           "Esc takes the force away at any time."));
    message_->setStyleSheet({});
    message_->show();
  }
}

void StylusSection::show_connection() {
  const LiveSession& live = session_.live();
  const bool held = live.is_connected();
  connect_->setText(held ? tr("Disconnect") : tr("Connect"));
  connect_->setEnabled(held || live.scan() != nullptr || !session_.why_no_scan().isEmpty());
  connect_->setToolTip(live.scan() ? QString() : tr("Open a scan first."));
  device_->setEnabled(!held);
  file_->setEnabled(!held);
  clutch_->setEnabled(held);
  leafing_ = false;  // whoever takes the stylus wants to see it
  show_own();
  show_scene();
  emit connection_shown(held, connect_->isEnabled());
}

const device::DeviceType* StylusSection::chosen_type() const {
  return device::find_device_type(device_->currentData().toString().section(QLatin1Char('@'), 0, 0).toStdString());
}

void StylusSection::show_technical(bool shown) {
  technical_ = shown;
  show_own();
}

/// Its limits are for developers; what concerns safety is always said.
void StylusSection::show_own() {
  const LiveSession& live = session_.live();
  QStringList lines;
  if (live.is_connected()) {
    const device::Specification& stylus = live.specification();
    if (stylus.force_axes == 0) {
      lines << tr("the device gives no force");
    } else {
      if (technical_) {
        lines << tr("the device's own limits: %1 N/m, %2 N (%3 N continuously)")
                     .arg(stylus.stiffness_limit, 0, 'f', 0)
                     .arg(stylus.maximum_force, 0, 'f', 1)
                     .arg(stylus.continuous_force, 0, 'f', 1);
      }
      for (const Text& text : live.drawn_down()) lines << in_qt(text);
      if (stylus.orientation_axes > 0) lines << tr("torque stays zero");
    }
    if (stylus.force_axes > 0) lines << without_program(stylus);
    lines << tested() << unguarded();
    lines.removeAll(QString());
  }
  own_->setText(lines.join(QLatin1Char('\n')));
}

/// How the driver of a real device was tested stays on the screen while it is connected.
QString StylusSection::tested() const {
  const device::DeviceType* const type = chosen_type();
  return type != nullptr && type->find != nullptr ? in_qt(type->tested) : QString();
}

/// What takes the force away when the program cannot: the guardian, and the device itself.
QStringList StylusSection::without_program(const device::Specification& stylus) const {
  const device::DeviceType* const type = chosen_type();
  if (type == nullptr || type->send_zeros == nullptr) return {};
  const QString watchdog = stylus.watchdog.empty() ? in_qt(type->watchdog) : QString::fromStdString(stylus.watchdog);
  QStringList lines{tr("the device's own watchdog: %1").arg(watchdog)};
  if (!stylus.guardian.empty()) lines << QString::fromStdString(stylus.guardian);
  return lines;
}

/// A session without a guardian says so for as long as it lasts.
QString StylusSection::unguarded() const {
  const device::DeviceType* const type = chosen_type();
  if (type == nullptr || type->send_zeros == nullptr || !device::guardian_program().empty()) return {};
  return tr("No guardian was found: if the program ends or hangs, only the device itself removes the force (%1). "
            "Install "
            "palpate-guardian.")
      .arg(in_qt(type->watchdog));
}

void StylusSection::show_scene() {
  const modes::Scene& scene = model_.scene();
  const QSignalBlocker quiet(stiffness_), quiet_too(limit_);
  stiffness_->setValue(scene.stiffness_n_per_m);
  limit_->setValue(scene.limits.force_n);
  const auto plan = session_.live().plan();
  scale_->setText(plan ? tr("%1 mm of patient per mm of hand").arg(plan->workspace.mm_per_m / 1e3, 0, 'f', 2)
                       : tr("no scan yet"));
  show_own();
}

SceneModel::Told StylusSection::told() {
  return [alive = QPointer(this)](const QString& why) {
    if (!alive || why.isEmpty()) return;
    show_message(*alive->message_, why, true);
    alive->show_own();
  };
}

void StylusSection::show_look(const SessionStatus& look) {
  clutch_->setChecked(look.clutched);
  const bool may = session_.may_remap();
  for (QToolButton* const fit : fits_) fit->setEnabled(may);
  go_->setEnabled(look.is_seen());
}

void StylusSection::remap(const QString& what, const modes::WorkspaceSettings& settings) {
  if (!session_.may_remap()) return;
  model_.edit(
      tr("Reach: %1").arg(what), [settings](modes::Scene& s) { s.workspace = settings; }, told());
}

void StylusSection::clutch(bool on) {
  if (on) {
    session_.clutch();
  } else {
    session_.unclutch(turn_->isChecked() ? rotation_of(eye_()) : session_.last().workspace.rotation);
  }
}

}  // namespace palpate::plugin
