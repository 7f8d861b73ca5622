#include "plugin/paraview/client/panel/footer.h"

#include <QDateTime>
#include <QDir>
#include <QFileDialog>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QStandardPaths>

#include <cmath>
#include <glm/geometric.hpp>

#include "plugin/paraview/client/panel/force_strip.h"
#include "plugin/paraview/client/stylus/session_state.h"
#include "plugin/report/summary.h"
#include "solver/solution.h"

namespace palpate::plugin {
namespace {

/// A label whose width does not follow its text, so that nothing beside it jumps.
QLabel* make_value(QWidget* parent, const char* name, const QString& tip) {
  auto* const label = new QLabel(QStringLiteral("–"), parent);
  label->setObjectName(QString::fromLatin1(name));
  label->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  label->setToolTip(tip);
  label->setTextFormat(Qt::PlainText);
  return label;
}

/// "-302 HU, soft tissue"; only the value where the tissue has no name. Units other than HU are not whole numbers.
QString value_text(double value, const QString& unit, const QString& tissue) {
  const QString number = unit == QLatin1String("HU") ? QString::number(value, 'f', 0) : QString::number(value, 'g', 4);
  const QString text = unit.isEmpty() ? number : QStringLiteral("%1 %2").arg(number, unit);
  return tissue.startsWith(QLatin1String("value ")) ? text : QStringLiteral("%1, %2").arg(text, tissue);
}

}  // namespace

Footer::Footer(SessionController& touching, const SceneModel& model, QWidget* parent)
    : QWidget(parent), touching_(touching), model_(model) {
  setObjectName(QStringLiteral("palpateFooter"));
  auto* const grid = new QGridLayout(this);
  grid->setContentsMargins(6, 4, 6, 6);
  grid->setVerticalSpacing(2);
  tissue_ = make_value(this, "palpateTissue", tr("Value of the scan and tissue at the proxy"));
  force_ = make_value(this, "palpateForce", tr("Force that the stylus is fed"));
  depth_ =
      make_value(this, "palpateDepth", tr("How far the stylus is past the boundary that holds it, in the patient"));
  solver_ = make_value(this, "palpateSolver",
                       tr("Which solver balanced the forces, and how far from the exact balance the proxy can be"));
  tick_ = make_value(this, "palpateTick", tr("Median time of a tick of the servo, and deadlines that it missed"));
  QFont large = force_->font();
  large.setPointSizeF(large.pointSizeF() * 1.4);
  large.setBold(true);
  force_->setFont(large);
  felt_ = make_value(this, "palpateFelt", tr("Scan, frame and scene that the stylus feels"));
  felt_->setWordWrap(true);
  felt_->setText(tr("No scan is open."));
  grid->addWidget(felt_, 7, 0, 1, 3);
  grid->addWidget(force_, 0, 0);
  grid->addWidget(depth_, 0, 1, 1, 2);
  grid->addWidget(tissue_, 1, 0, 1, 3);
  distance_ = make_value(this, "palpateDistance",
                         tr("From the proxy to the structure that is nearest, of those that the scene reads; in color "
                            "within its margin"));
  distance_->hide();
  grid->addWidget(distance_, 8, 0, 1, 3);
  strip_ = new ForceStrip(this);
  grid->addWidget(strip_, 2, 0, 1, 3);
  grid->addWidget(solver_, 3, 0, 1, 3);
  grid->addWidget(tick_, 4, 0, 1, 2);
  record_ = new QPushButton(tr("Record…"), this);
  record_->setObjectName(QStringLiteral("palpateRecord"));
  record_->setToolTip(
      tr("Keeps every tick in a file that can be repeated to the last bit. No patient's name goes into it."));
  connect(record_, &QPushButton::clicked, this, [this] { toggle_recording(); });
  grid->addWidget(record_, 4, 2);
  release_ = new QPushButton(tr("Release  (Esc)"), this);
  release_->setObjectName(QStringLiteral("palpateRelease"));
  release_->setMinimumHeight(38);
  release_->setStyleSheet(
      QStringLiteral("QPushButton { background: #b00020; color: white; font-weight: bold; border-radius: 4px }"
                     "QPushButton:pressed { background: #7a0016 }"
                     "QPushButton:disabled { background: palette(mid); color: palette(dark) }"));
  connect(release_, &QPushButton::clicked, this, [this] { touching_.release(); });
  release_->setMinimumWidth(120);
  auto* const row = new QHBoxLayout;
  lamp_ = new QLabel(this);
  lamp_->setObjectName(QStringLiteral("palpateLamp"));
  lamp_->setFixedSize(12, 12);
  row->addWidget(lamp_);
  state_ = new QLabel(this);
  state_->setObjectName(QStringLiteral("palpateState"));
  state_->setWordWrap(true);
  state_->setTextFormat(Qt::PlainText);
  state_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  row->addWidget(state_, 1);
  grid->addLayout(row, 5, 0, 1, 3);
  auto* const buttons = new QHBoxLayout;
  feel_ = new QPushButton(tr("Feel"), this);
  feel_->setObjectName(QStringLiteral("palpateFeel"));
  feel_->setMinimumHeight(38);
  connect(feel_, &QPushButton::clicked, this,
          [this] { state_line_of(touching_.last()).fault_latched ? touching_.clear_fault() : touching_.feel(); });
  buttons->addWidget(feel_, 1);
  buttons->addWidget(release_, 1);
  grid->addLayout(buttons, 6, 0, 1, 3);
  grid->setColumnStretch(0, 2);
  grid->setColumnStretch(1, 3);
  connect(&touching, &SessionController::looked, this, [this](const SessionStatus& look) { show_look(look); });
  connect(&touching, &SessionController::connection_changed, this, [this] { show_connection(); });
  show_connection();
}

void Footer::show_connection() {
  const bool connected = touching_.live().is_connected();
  release_->setEnabled(connected);
  record_->setEnabled(connected);
  record_->setText(touching_.live().recording() ? tr("Stop recording") : tr("Record…"));
}

void Footer::toggle_recording() {
  if (touching_.live().recording()) {
    touching_.stop_recording();
    return;
  }
  const QString name =
      QStringLiteral("palpate-%1.h5").arg(QDateTime::currentDateTime().toString(QStringLiteral("yyyyMMdd-HHmmss")));
  const QString folder = QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation);
  const QString file =
      QFileDialog::getSaveFileName(this, tr("Record to"), QDir(folder).filePath(name), tr("Recordings (*.h5)"));
  if (!file.isEmpty()) touching_.record(file.toStdString());
}

void Footer::set_felt(const QString& words) {
  if (felt_->text() == words) return;
  felt_->setText(words);
  felt_->setToolTip(words);
}

void Footer::show_state(const SessionStatus& look) {
  const StateLine line = state_line_of(look);
  feel_->setText(line.fault_latched ? tr("Clear fault") : tr("Feel"));
  feel_->setEnabled(line.fault_latched || line.state == SessionState::ready);
  if (state_->text() == line.words) return;
  state_->setText(line.words);
  state_->setToolTip(line.words);
  // Colors that the color-blind can tell apart, too; and the state is always there in words.
  const char* color = "#808080";
  if (line.state == SessionState::ready) color = "#56b4e9";
  if (line.state == SessionState::feeling) color = "#009e73";
  if (line.state == SessionState::stopped) color = "#d55e00";
  lamp_->setStyleSheet(QStringLiteral("background: %1; border-radius: 6px").arg(QLatin1String(color)));
}

/// Room is taken for it only where there are structures.
void Footer::show_distance(const SessionStatus& look) {
  const bool told = (look.connected || look.replayed) && look.nearest.has_value();
  distance_->setVisible(told);
  if (!told) return;
  const modes::Scene& scene = look.scene ? *look.scene : model_.scene();
  if (look.nearest->structure >= scene.structures.size()) return;
  const std::string& name = scene.structures[look.nearest->structure].name;
  const QString words = QString::fromStdString(distance_in_words(look.nearest->distance_mm, name));
  distance_->setText(look.nearest->within_margin ? tr("⚠ %1: within its margin").arg(words) : words);
  distance_->setStyleSheet(look.nearest->within_margin
                               ? QStringLiteral("background: #d55e00; color: white; font-weight: bold; padding: 2px")
                               : QString());
}

void Footer::show_look(const SessionStatus& look) {
  show_state(look);
  show_distance(look);
  if (!look.connected && !look.replayed) {
    force_->setText(QStringLiteral("–"));
    depth_->setText(tr("no stylus"));
    tissue_->setText(QStringLiteral("–"));
    solver_->setText(QStringLiteral("–"));
    tick_->setText(QStringLiteral("–"));
    return;
  }
  const TickRecord& frame = look.frame;
  strip_->set_limit(model_.scene().limits.force_n);
  strip_->add(look.peak_n);
  force_->setText(tr("%1 N").arg(look.force_n, 0, 'f', 2));
  const double depth_mm = glm::length(look.proxy_mm - look.probe_mm);
  const QString depth = tr("%1 mm").arg(depth_mm, 0, 'f', 1);
  depth_->setText(look.force_n == 0   ? tr("nothing held")
                  : look.held.empty() ? tr("%1 behind the proxy").arg(depth)
                                      : tr("%1 past %2").arg(depth, QString::fromStdString(look.held)));
  depth_->setToolTip(depth_->text());
  const QString tissue = QString::fromStdString(look.tissue);
  const std::string unit = touching_.live().scan() ? touching_.live().scan()->unit : std::string();
  tissue_->setText(std::isfinite(frame.value) ? value_text(frame.value, QString::fromStdString(unit), tissue)
                                              : tr("outside the scan"));
  const double error_mm = 1e3 * frame.error_bound_m;
  constexpr double small_mm = 1e-9;
  solver_->setText(tr("%1 solver, error below %2 mm")
                       .arg(QString::fromLatin1(solver::name_of(static_cast<solver::SolverKind>(frame.solver))))
                       .arg(error_mm < small_mm ? small_mm : error_mm, 0, 'g', 2));
  tick_->setText(look.replayed ? tr("recorded: tick %1 µs").arg(look.tick_us, 0, 'f', 1)
                               : tr("tick %1 µs, %2 missed").arg(look.tick_us, 0, 'f', 1).arg(look.missed));
}

}  // namespace palpate::plugin
