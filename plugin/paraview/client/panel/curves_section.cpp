#include "plugin/paraview/client/panel/curves_section.h"

#include <QApplication>
#include <QColor>
#include <QComboBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPointer>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "plugin/paraview/client/model/shown_mode.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/widgets/tool_button.h"
#include "plugin/paraview/client/words/mode_words.h"

namespace palpate::plugin {
namespace {

/// A curve's shape, from 0 to 1 of the histogram's width and of the strength.
struct Preset {
  const char* name;
  std::vector<modes::Node> nodes;
};
const std::vector<Preset>& presets() {
  static const std::vector<Preset> all{
      {QT_TRANSLATE_NOOP("palpate::plugin::CurvesSection", "Soft edge: the force rises gradually"),
       {{0.05, 0}, {0.5, 1}}},
      {QT_TRANSLATE_NOOP("palpate::plugin::CurvesSection", "Firm edge: the full force at once"),
       {{0.08, 0}, {0.12, 1}}},
      {QT_TRANSLATE_NOOP("palpate::plugin::CurvesSection", "Steep edges only"), {{0.35, 0}, {0.5, 1}}},
      {QT_TRANSLATE_NOOP("palpate::plugin::CurvesSection", "Everywhere the same"), {{0, 1}}}};
  return all;
}

modes::Gate* gate_of(modes::Mode& mode) {
  auto& gates = mode.gates;
  const auto of_value =
      std::find_if(gates.begin(), gates.end(), [](const modes::Gate& gate) { return gate.of == modes::Datum::value; });
  return of_value == gates.end() ? nullptr : &*of_value;
}

}  // namespace

CurvesSection::CurvesSection(SceneModel& model, SessionController& session, StrokeRunner& strokes, QWidget* parent)
    : QWidget(parent), model_(model) {
  setObjectName(QStringLiteral("palpateCurves"));
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  auto* const row = new QHBoxLayout;
  modes_ = new QComboBox(this);
  modes_->setObjectName(QStringLiteral("palpateCurveOf"));
  modes_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  connect(modes_, QOverload<int>::of(&QComboBox::activated), this, [this] { show_mode(); });
  row->addWidget(modes_, 1);
  add_tool_button(*row, *this, "palpateUndo", QStringLiteral("↶"),
                  tr("Undo. Hold B to feel the scene as it was before the last edit."), [this] { model_.undo(); });
  add_tool_button(*row, *this, "palpateRedo", QStringLiteral("↷"), tr("Redo"), [this] { model_.redo(); });
  column->addLayout(row);
  strength_ = new CurveEditor(QStringLiteral("palpateStrengthCurve"), tr("gradient"), tr("strength, N"), this);
  column->addWidget(strength_);
  profile_ = new CurveProfile(session, model, strokes, this);
  column->addWidget(profile_);
  gate_ = new CurveEditor(QStringLiteral("palpateGateCurve"), tr("value"), tr("factor"), this);
  column->addWidget(gate_);
  message_ = make_message_label(*this, "palpateCurveMessage");
  message_->hide();
  column->addWidget(message_);
  presets_ = new QComboBox(this);
  presets_->setObjectName(QStringLiteral("palpatePresets"));
  presets_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  presets_->setMinimumContentsLength(10);
  presets_->addItem(tr("Preset curve…"));
  for (const Preset& preset : presets()) presets_->addItem(tr(preset.name));
  connect(presets_, QOverload<int>::of(&QComboBox::activated), this, [this](int index) { use_preset(index); });
  column->addWidget(presets_);
  const auto connect_editor = [this](CurveEditor* editor, auto put) {
    connect(editor, &CurveEditor::dragged, this, [this, editor, put] {
      if (mode() >= model_.scene().modes.size()) return;
      model_.drag([shown = ShownMode(model_, mode()), curve = editor->curve(),
                   put](modes::Scene& scene) { put(scene.modes[shown.in(scene)], curve); },
                  [alive = QPointer(this)](const QString& why) {
                    if (alive) show_message(*alive->message_, why, true);
                  });
    });
    connect(editor, &CurveEditor::finished, this, [this] {
      if (QGuiApplication::mouseButtons() == Qt::NoButton) profile_->rest();
      if (mode() < model_.scene().modes.size()) {
        model_.finish_drag(tr("Curve of %1").arg(name_of(model_.scene(), mode())));
      }
      if (message_->isVisibleTo(this)) show_mode();  // what was refused goes back to what is felt
    });
  };
  connect_editor(strength_, [](modes::Mode& mode, const modes::TransferFunction& curve) { mode.strength_n = curve; });
  connect_editor(gate_, [](modes::Mode& mode, const modes::TransferFunction& curve) {
    if (modes::Gate* const gate = gate_of(mode)) gate->factor = curve;
  });
  connect(&model, &SceneModel::changed, this, [this](Pace pace) {
    if (pace == Pace::dragged) return;  // it is this curve's
    message_->hide();
    list_modes();
  });
  list_modes();
  QCoreApplication::instance()->installEventFilter(this);
}

void CurvesSection::mark(const std::optional<io::Sample>& pointed) {
  if (!isVisible() || !study_) return;
  const bool of_gradient = mode() < model_.scene().modes.size() &&
                           model_.scene().modes[mode()].strength_of == modes::Datum::gradient_magnitude;
  std::optional<double> value, strength;
  if (pointed) {
    value = pointed->value;
    strength = of_gradient ? glm::length(pointed->gradient) : pointed->value;
  }
  strength_->set_mark(strength);
  gate_->set_mark(value);
}

bool CurvesSection::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::MouseButtonPress) profile_->rest();  // a drag may pause: it begins with a press
  if (event->type() == QEvent::ApplicationDeactivate) end_before();
  const bool pressed = event->type() == QEvent::KeyPress || event->type() == QEvent::ShortcutOverride;
  if (!pressed && event->type() != QEvent::KeyRelease) return QWidget::eventFilter(watched, event);
  const auto& key = *static_cast<QKeyEvent*>(event);
  if (key.key() != Qt::Key_B) return QWidget::eventFilter(watched, event);
  if (key_held_) {  // whatever else is held, open or in focus by now
    if (!pressed && !key.isAutoRepeat()) end_before();
    return true;
  }
  QWidget* const writes = QApplication::focusWidget();
  const bool text = writes && (writes->inherits("QLineEdit") || writes->inherits("QAbstractSpinBox") ||
                               writes->inherits("QTextEdit"));
  if (!key_shows_before_ || key.modifiers() != Qt::NoModifier || text || QApplication::activeModalWidget()) {
    return QWidget::eventFilter(watched, event);
  }
  if (pressed && !key.isAutoRepeat()) {
    key_held_ = true;
    model_.show_before();
  }
  return true;  // ParaView would select blocks
}

void CurvesSection::end_before() {
  if (std::exchange(key_held_, false)) model_.show_now();
}

void CurvesSection::set_study(const std::shared_ptr<const ScanStudy>& study, const QString& unit) {
  study_ = study;
  unit_ = unit;
  if (!study_) strength_->clear();
  show_mode();
}

std::size_t CurvesSection::mode() const {
  return modes_->currentIndex() < 0 ? modes::Scene::most_modes : static_cast<std::size_t>(modes_->currentIndex());
}

void CurvesSection::list_modes() {
  QStringList names;
  for (std::size_t n = 0; n < model_.scene().modes.size(); ++n) {
    names << name_of(model_.scene(), n);
  }
  const int was = modes_->currentIndex();
  modes_->clear();
  modes_->addItems(names);
  modes_->setCurrentIndex(std::clamp(was, names.isEmpty() ? -1 : 0, static_cast<int>(names.size()) - 1));
  show_mode();
}

const Counts& CurvesSection::counts_of(modes::Datum datum) const {
  return datum == modes::Datum::gradient_magnitude ? study_->magnitudes : study_->values;
}

void CurvesSection::show_mode() {
  modes::Scene scene = model_.scene();
  const bool any = study_ && mode() < scene.modes.size();
  strength_->setEnabled(any);
  presets_->setEnabled(any);
  const modes::Gate* const gate = any ? gate_of(scene.modes[mode()]) : nullptr;
  gate_->setVisible(gate != nullptr);
  if (!any) return;
  const modes::Mode& shown = scene.modes[mode()];
  const QColor color = color_of(shown);
  const QString value = unit_.isEmpty() ? tr("value") : unit_;
  const QString gradient = unit_.isEmpty() ? tr("gradient per mm") : tr("%1 per mm").arg(unit_);
  const double top_n = std::max({scene.limits.force_n, shown.strength_n.maximum(), 0.1});
  strength_->set_frame(counts_of(shown.strength_of),
                       shown.strength_of == modes::Datum::gradient_magnitude ? gradient : value, top_n);
  strength_->set_curve(shown.strength_n, color);
  if (!gate) return;
  gate_->set_frame(study_->values, value, 1);
  gate_->set_curve(gate->factor, color);
}

void CurvesSection::use_preset(int index) {
  presets_->setCurrentIndex(0);
  if (index <= 0 || !study_ || mode() >= model_.scene().modes.size()) return;
  const Preset& preset = presets()[static_cast<std::size_t>(index - 1)];
  const auto shape = [&preset, bins = counts_of(model_.scene().modes[mode()].strength_of).bins](modes::Mode& changed) {
    const double strongest = changed.strength_n.maximum() > 0 ? changed.strength_n.maximum() : 1;
    std::vector<modes::Node> nodes = preset.nodes;
    for (modes::Node& node : nodes) node = {bins.low + node.at * (bins.high - bins.low), node.value * strongest};
    changed.strength_n = modes::TransferFunction(std::move(nodes), changed.strength_n.interpolation());
  };
  model_.edit_mode(tr("Shape: %1").arg(tr(preset.name)), mode(), shape, [alive = QPointer(this)](const QString& why) {
    if (alive) show_message(*alive->message_, why, true);
  });
}

}  // namespace palpate::plugin
