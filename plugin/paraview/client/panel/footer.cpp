#include "plugin/paraview/client/panel/footer.h"

#include <QDateTime>
#include <QDir>
#include <QFileDialog>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSettings>
#include <QStandardPaths>
#include <QToolButton>

#include <cmath>
#include <glm/geometric.hpp>

#include "plugin/paraview/client/model/session_state.h"
#include "plugin/paraview/client/panel/force_strip.h"
#include "plugin/paraview/client/widgets/kept_width.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/widgets/release_button.h"
#include "plugin/paraview/client/words.h"
#include "plugin/report/summary.h"
#include "solver/solver_type.h"

namespace palpate::plugin {
namespace {

/// A label whose width does not follow its text, so that nothing beside it jumps.
QLabel* make_value(QWidget* parent, const char* name, const QString& tip) {
  auto* const label = new QLabel(parent);
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

Footer::Footer(SessionController& session, const SceneModel& model, QWidget* parent)
    : QWidget(parent), session_(session), model_(model) {
  setObjectName(QStringLiteral("palpateFooter"));
  auto* const grid = new QGridLayout(this);
  grid->setContentsMargins(6, 4, 6, 6);
  grid->setVerticalSpacing(2);
  grid->setColumnStretch(0, 2);
  grid->setColumnStretch(1, 3);
  add_values(*grid);
  add_technical(*grid);
  grid->addLayout(make_state(), 7, 0, 1, 3);
  grid->addLayout(make_buttons(), 9, 0, 1, 3);
  connect(&session, &SessionController::polled, this, [this](const SessionStatus& look) { show_look(look); });
  connect(&session, &SessionController::connection_changed, this, [this] { show_connection(); });
  show_connection();
}

/// The felt values and their scan. The footer ends at the panel's lower edge: lines that may wrap are above all
/// buttons, so that the buttons keep their places.
void Footer::add_values(QGridLayout& grid) {
  force_ = make_value(this, "palpateForce", tr("Force on the stylus"));
  QFont large = force_->font();
  large.setPointSizeF(large.pointSizeF() * 1.4);
  large.setBold(true);
  force_->setFont(large);
  grid.addWidget(force_, 2, 0);
  tissue_ = make_value(this, "palpateTissue", tr("Value of the scan and tissue at the proxy"));
  grid.addWidget(tissue_, 2, 1, 1, 2);
  depth_ = make_value(this, "palpateDepth",
                      tr("How far the stylus has gone past the boundary that holds it, in mm in the patient"));
  grid.addWidget(depth_, 3, 0, 1, 3);  // the longest: a boundary's name, and how well its place is known
  strip_ = new ForceStrip(this);
  grid.addWidget(strip_, 4, 0, 1, 3);
  felt_ = make_value(this, "palpateFelt", tr("Scan, frame and scene that the stylus feels"));
  felt_->setWordWrap(true);
  felt_->setText(tr("No scan is open."));
  grid.addWidget(felt_, 0, 0, 1, 3);
  distance_ = make_value(this, "palpateDistance",
                         tr("Distance to the nearest structure of the scene; colored inside its margin"));
  distance_->hide();
  grid.addWidget(distance_, 1, 0, 1, 3);
}

/// The solver and the tick, which are shown when they are asked for, and the button that records.
void Footer::add_technical(QGridLayout& grid) {
  solver_ = make_value(this, "palpateSolver",
                       tr("Which solver balanced the forces, and how far from the exact balance the proxy can be"));
  tick_ = make_value(this, "palpateTick", tr("Median time of a tick of the servo, and deadlines that it missed"));
  grid.addWidget(solver_, 5, 0, 1, 3);
  grid.addWidget(tick_, 6, 0, 1, 3);
  technical_ = new QToolButton(this);
  technical_->setObjectName(QStringLiteral("palpateTechnical"));
  technical_->setText(tr("Technical"));
  technical_->setToolTip(
      tr("For developers: solver, servo, the stylus' own limits, and the parts of the scene that are left out"));
  technical_->setCheckable(true);
  technical_->setAutoRaise(true);
  connect(technical_, &QToolButton::toggled, this, [this](bool on) {
    QSettings().setValue(QStringLiteral("palpate/technical"), on);
    show_technical(on);
    emit technical_changed(on);
  });
  technical_->setChecked(QSettings().value(QStringLiteral("palpate/technical"), false).toBool());
  show_technical(technical_->isChecked());
  grid.addWidget(technical_, 8, 0);
  record_ = new QPushButton(tr("Record…"), this);
  record_->setObjectName(QStringLiteral("palpateRecord"));
  keep_width(*record_, {tr("Record…"), tr("Stop recording")});
  record_->setToolTip(
      tr("Records all that is felt in a file, to be replayed later. The file holds no patient's name."));
  connect(record_, &QPushButton::clicked, this, [this] { toggle_recording(); });
  grid.addWidget(record_, 8, 2);
}

/// A lamp, and the state in words.
QLayout* Footer::make_state() {
  auto* const row = new QHBoxLayout;
  lamp_ = new QLabel(this);
  lamp_->setObjectName(QStringLiteral("palpateLamp"));
  lamp_->setFixedSize(12, 12);
  row->addWidget(lamp_);
  state_ = make_message_label(*this, "palpateState");
  state_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  row->addWidget(state_, 1);
  return row;
}

/// Feel, Mark and Release.
QLayout* Footer::make_buttons() {
  auto* const row = new QHBoxLayout;
  // Made first: the tab key comes to it first.
  release_ = make_release_button(*this, "palpateRelease", tr("Release  (Esc)"));
  release_->setMinimumSize(120, 38);
  connect(release_, &QPushButton::clicked, this, [this] { session_.release(); });
  feel_ = new QPushButton(tr("Feel"), this);
  feel_->setObjectName(QStringLiteral("palpateFeel"));
  feel_->setMinimumHeight(38);
  connect(feel_, &QPushButton::clicked, this,
          [this] { state_line_of(session_.last()).needs_clearing() ? session_.clear_fault() : session_.feel(); });
  row->addWidget(feel_, 1);
  mark_ = new QPushButton(this);
  mark_->setObjectName(QStringLiteral("palpateMark"));
  mark_->setMinimumHeight(38);
  set_corrects(false);
  mark_->setFocusPolicy(Qt::NoFocus);  // the keys are the views'
  connect(mark_, &QPushButton::pressed, this, [this] { session_.press_mark(); });
  connect(mark_, &QPushButton::released, this, [this] { session_.let_go_mark(); });
  row->addWidget(mark_, 1);
  row->addWidget(release_, 1);
  return row;
}

void Footer::set_corrects(bool corrects) {
  mark_->setText(corrects ? tr("Correct  (M)") : tr("Mark  (M)"));
  mark_->setToolTip(
      corrects ? tr("Corrects the outline with the chosen tool at the point that the stylus touches. Keep it pressed "
                    "while the stylus moves along the true edge. The stylus' second button and the key M in a view do "
                    "the same.")
               : tr("Marks the point that the stylus touches. Keep it pressed while the stylus moves to mark a path. "
                    "The stylus' second button and the key M in a view do the same."));
}

/// For developers, and for a clinician who is asked about it.
void Footer::show_technical(bool shown) {
  solver_->setVisible(shown);
  tick_->setVisible(shown);
}

bool Footer::is_technical() const {
  return technical_->isChecked();
}

void Footer::show_connection() {
  const bool connected = session_.live().is_connected();
  release_->setEnabled(connected);
  record_->setEnabled(connected);
  mark_->setEnabled(connected);
  record_->setText(session_.live().recording() ? tr("Stop recording") : tr("Record…"));
}

void Footer::toggle_recording() {
  if (session_.live().recording()) {
    session_.stop_recording();
    return;
  }
  const QString name =
      QStringLiteral("palpate-%1.h5").arg(QDateTime::currentDateTime().toString(QStringLiteral("yyyyMMdd-HHmmss")));
  const QString folder = QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation);
  const QString file =
      QFileDialog::getSaveFileName(this, tr("Record to"), QDir(folder).filePath(name), tr("Recordings (*.h5)"));
  if (!file.isEmpty()) session_.record(file.toStdString());
}

void Footer::set_felt(const QString& words, bool scan_open) {
  scan_open_ = scan_open;
  if (felt_->text() == words) return;
  felt_->setText(words);
  felt_->setToolTip(words);
}

void Footer::show_state(const SessionStatus& look) {
  const StateLine line = state_line_of(look);
  feel_->setText(line.lost ? tr("Open the stylus again") : line.fault_latched ? tr("Clear fault") : tr("Feel"));
  feel_->setEnabled(line.needs_clearing() || line.state == SessionState::ready);
  const QString kept = line.fault_latched ? session_.last_fault() : QString();
  const QString tip = kept.isEmpty() ? line.words : line.words + QLatin1Char('\n') + kept;
  if (state_->toolTip() != tip) state_->setToolTip(tip);
  if (state_->text() == line.words) return;
  state_->setText(line.words);
  // Colors that the color-blind can tell apart, too; and the state is always there in words.
  const char* color = "#808080";
  if (line.state == SessionState::ready) color = "#56b4e9";
  if (line.state == SessionState::feeling) color = "#009e73";
  if (line.state == SessionState::stopped) color = "#d55e00";
  lamp_->setStyleSheet(QStringLiteral("background: %1; border-radius: 6px").arg(QLatin1String(color)));
}

/// Room is taken for it only where there are structures.
bool Footer::is_of_the_scan() const {
  return scan_open_ && !session_.expects_scan();
}

void Footer::show_distance(const SessionStatus& look) {
  const bool told = is_of_the_scan() && (look.connected || look.replayed) && look.nearest.has_value();
  distance_->setVisible(told);
  if (!told) return;
  const modes::Scene& scene = look.scene ? *look.scene : model_.scene();
  if (look.nearest->structure >= scene.structures.size()) return;
  const std::string& name = scene.structures[look.nearest->structure].name;
  const QString words = QString::fromStdString(distance_in_words(look.nearest->distance_mm, name));
  distance_->setText(look.nearest->within_margin ? tr("⚠ %1: within its margin").arg(words) : words);
  const QString style = look.nearest->within_margin
                            ? QStringLiteral("background: #d55e00; color: white; font-weight: bold; padding: 2px")
                            : QString();
  if (distance_->styleSheet() != style) distance_->setStyleSheet(style);
}

void Footer::show_look(const SessionStatus& look) {
  show_state(look);
  show_distance(look);
  if (!look.connected && !look.replayed) {
    force_->setText({});  // clear() paints the whole window anew, thirty times a second
    depth_->setText(tr("no stylus"));
    tissue_->setText({});
    solver_->setText(QStringLiteral("–"));
    tick_->setText(QStringLiteral("–"));
    return;
  }
  const TickRecord& tick = look.tick;
  strip_->set_limit(model_.scene().limits.force_n);
  strip_->add(look.peak_n);
  force_->setText(look.may_push ? tr("unknown") : tr("%1 N").arg(look.force_n, 0, 'f', 2));
  const double depth_mm = glm::length(look.proxy_mm - look.probe_mm);
  const QString depth = tr("%1 mm").arg(depth_mm, 0, 'f', 1);
  const bool touches = glm::length(vector_of(tick.sent_n)) > 0;  // as the session has it, whatever the device gets
  const QString past = !touches            ? tr("no boundary touched")
                       : look.held.empty() ? tr("%1 from the proxy").arg(depth)
                                           : tr("%1 past %2").arg(depth, QString::fromStdString(look.held));
  // The tool tip has the whole of a shortened name; depth and error stay.
  depth_->setText(depth_->fontMetrics().elidedText(past, Qt::ElideMiddle, depth_->width()));
  depth_->setToolTip(past);
  const QString tissue = tissue_in_words(look.tissue);
  const std::string unit = session_.live().scan() ? session_.live().scan()->unit : std::string();
  // Else the tick is of a scan that is gone, or of the one before.
  tissue_->setText(!is_of_the_scan()           ? QString()
                   : std::isfinite(tick.value) ? value_text(tick.value, QString::fromStdString(unit), tissue)
                                               : tr("outside the scan"));
  const double error_mm = 1e3 * tick.error_bound_m;
  constexpr double small_mm = 1e-9;
  solver_->setText(tr("%1 solver, error below %2 mm")
                       .arg(QString::fromStdString(std::string(solver::name_of(solver::solver_of_number(tick.solver)))))
                       .arg(error_mm < small_mm ? small_mm : error_mm, 0, 'g', 2));
  tick_->setText(look.replayed ? tr("recorded: tick %1 µs").arg(look.tick_us, 0, 'f', 1)
                               : tr("tick %1 µs, %2 missed").arg(look.tick_us, 0, 'f', 1).arg(look.missed));
}

}  // namespace palpate::plugin
