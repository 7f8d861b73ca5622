#include "plugin/paraview/client/panel/curve_editor.h"

#include <QVTKOpenGLNativeWidget.h>
#include <QVTKOpenGLStereoWidget.h>
#include <pqCoreUtilities.h>
#include <pqTransferFunctionWidget.h>
#include <vtkCallbackCommand.h>
#include <vtkChart.h>
#include <vtkCommand.h>
#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPVDiscretizableColorTransferFunction.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPropCollection.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkTable.h>

#include <QColor>
#include <QDoubleSpinBox>
#include <QEvent>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QSignalBlocker>
#include <QTimer>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>
#include <utility>

#include "plugin/paraview/client/panel/chart_mark.h"
#include "plugin/paraview/client/views/event_watch.h"

namespace palpate::plugin {
namespace {

constexpr int at_rest_ms = 300;
constexpr float before_chart = 10;

}  // namespace

/// Presses, before the chart sees them: when a drag begins and ends, and drags with Shift held down.
class CurveEditor::Block {
 public:
  Block(CurveEditor& owner, vtkRenderWindowInteractor& interactor, vtkChart& chart)
      : owner_(owner),
        interactor_(&interactor),
        chart_(&chart),
        events_(&interactor,
                {vtkCommand::LeftButtonPressEvent, vtkCommand::MouseMoveEvent, vtkCommand::LeftButtonReleaseEvent},
                before_chart, [this](unsigned long event) { return handle(event); }) {}

 private:
  bool handle(unsigned long event) {
    const int x = interactor_->GetEventPosition()[0];
    if (event == vtkCommand::LeftButtonPressEvent) {
      dragging_ = interactor_->GetShiftKey() != 0;
      from_ = x;
      owner_.press();
      if (dragging_) owner_.shifted_from_.clear();
      return dragging_;
    }
    if (event == vtkCommand::LeftButtonReleaseEvent) {
      owner_.let_go();
      return std::exchange(dragging_, false);
    }
    if (!dragging_) return false;
    const double width = chart_->GetPoint2()[0] - chart_->GetPoint1()[0];
    const io::Bins& bins = owner_.counts_.bins;
    if (width > 0) owner_.shift_to((x - from_) / width * (bins.high - bins.low));
    return true;
  }

  CurveEditor& owner_;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor_;
  vtkSmartPointer<vtkChart> chart_;
  bool dragging_ = false;
  int from_ = 0;
  EventWatch events_;
};

struct CurveEditor::Functions {
  vtkNew<vtkPiecewiseFunction> curve;  // 0 to 1, as the widget has it
  vtkNew<vtkPVDiscretizableColorTransferFunction> colors;
  vtkNew<vtkCallbackCommand> modified;
};

CurveEditor::CurveEditor(const QString& name, const QString& across, const QString& up, QWidget* parent)
    : QWidget(parent), functions_(std::make_unique<Functions>()), across_(across), up_(up) {
  setObjectName(name);
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  functions_->curve->AddPoint(0, 0);
  functions_->curve->AddPoint(1, 1);
  functions_->colors->AddRGBPoint(0, 0.8, 0.8, 0.8);
  functions_->colors->AddRGBPoint(1, 0.8, 0.8, 0.8);
  functions_->modified->SetClientData(this);
  functions_->modified->SetCallback(
      [](vtkObject*, unsigned long, void* self, void*) { static_cast<CurveEditor*>(self)->curve_modified(); });
  functions_->curve->AddObserver(vtkCommand::ModifiedEvent, functions_->modified);
  widget_ = new pqTransferFunctionWidget(this);
  widget_->setObjectName(name + QStringLiteral("Chart"));
  widget_->setMinimumHeight(110);
  widget_->setToolTip(
      tr("Drag a node to move it; click to add one. Delete removes the chosen node, and the arrow keys move it. Drag "
         "with Shift to move the whole curve. The line marks what is under the pointer in a slice."));
  widget_->initialize(functions_->colors, false, functions_->curve, true);
  widget_->installEventFilter(this);
  for (QWidget* const part : widget_->findChildren<QWidget*>()) part->installEventFilter(this);
  connect(widget_, &pqTransferFunctionWidget::currentPointChanged, this, [this] { show_node(); });
  column->addWidget(widget_);
  axes_ = new QLabel(this);
  axes_->setObjectName(name + QStringLiteral("Axes"));
  axes_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  axes_->setWordWrap(true);
  column->addWidget(axes_);
  auto* const row = new QHBoxLayout;
  row->addWidget(new QLabel(tr("Node"), this));
  const auto add = [&](const QString& suffix) {
    auto* const box = new QDoubleSpinBox(this);
    box->setObjectName(name + suffix);
    box->setKeyboardTracking(false);
    box->setRange(-1e6, 1e6);
    connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
            [this] { set_node(at_->value(), value_->value()); });
    row->addWidget(box, 1);
    return box;
  };
  at_ = add(QStringLiteral("At"));
  value_ = add(QStringLiteral("Value"));
  column->addLayout(row);
  rest_ = new QTimer(this);
  rest_->setSingleShot(true);
  rest_->setInterval(at_rest_ms);
  connect(rest_, &QTimer::timeout, this, [this] { emit finished(); });
  show_axes();
  show_node();
}

CurveEditor::~CurveEditor() {
  functions_->curve->RemoveObserver(functions_->modified);
}

void CurveEditor::set_frame(const Counts& counts, const QString& across, double top) {
  counts_ = counts;
  across_ = across;
  top_ = top;
  vtkNew<vtkTable> table;
  vtkNew<vtkDoubleArray> extents, values;
  extents->SetName("bin_extents");
  values->SetName("bin_values");
  for (std::size_t n = 0; n < counts.counts.size(); ++n) {
    extents->InsertNextValue(counts.bins.middle(static_cast<int>(n)));
    values->InsertNextValue(std::log1p(counts.counts[n]));  // air is a thousand times as much as a boundary
  }
  table->AddColumn(extents);
  table->AddColumn(values);
  widget_->setHistogramTable(table);
  const QSignalBlocker quiet(at_), quiet_too(value_);
  at_->setRange(counts.bins.low, counts.bins.high);
  at_->setSingleStep(counts.bins.width());
  at_->setDecimals(counts.bins.high - counts.bins.low > 20 ? 0 : 2);
  value_->setRange(0, top);
  value_->setSingleStep(top / 50);
  show_axes();
}

/// The ends of the range have as many decimals as the number of a node: a speed of 0 to 1.2 m/s is not "0 … 1".
void CurveEditor::show_axes() {
  axes_->setText(QStringLiteral("→ %1,\u00a0%2\u00a0…\u00a0%3   ↑ %4,\u00a00\u00a0…\u00a0%5")
                     .arg(across_)
                     .arg(counts_.bins.low, 0, 'f', at_->decimals())
                     .arg(counts_.bins.high, 0, 'f', at_->decimals())
                     .arg(up_)
                     .arg(top_, 0, 'g', 3));
  axes_->setToolTip(axes_->text());
}

void CurveEditor::set_curve(const modes::TransferFunction& curve, const QColor& color) {
  setting_ = true;
  find_chart();
  color_ = color;
  interpolation_ = curve.interpolation();
  vtkPiecewiseFunction& shown = *functions_->curve;
  const double low = counts_.bins.low, high = counts_.bins.high;
  shown.RemoveAllPoints();
  // The widget keeps its two ends whatever happens: the curve is constant beyond its own.
  shown.AddPoint(low, std::clamp(curve(low) / top_, 0.0, 1.0));
  for (const modes::Node& node : curve.nodes()) {
    if (node.at > low && node.at < high) shown.AddPoint(node.at, std::clamp(node.value / top_, 0.0, 1.0));
  }
  shown.AddPoint(high, std::clamp(curve(high) / top_, 0.0, 1.0));
  functions_->colors->RemoveAllPoints();
  for (const double at : {low, high}) {
    functions_->colors->AddRGBPoint(at, color.redF(), color.greenF(), color.blueF());
  }
  setting_ = false;
  widget_->render();
  show_node();
}

modes::TransferFunction CurveEditor::curve() const {
  vtkPiecewiseFunction& shown = *functions_->curve;
  std::vector<modes::Node> nodes;
  for (int n = 0; n < shown.GetSize(); ++n) {
    double node[4];
    shown.GetNodeValue(n, node);
    if (!nodes.empty() && node[0] <= nodes.back().at) continue;
    nodes.push_back({node[0], std::max(node[1], 0.0) * top_});
  }
  // The ends are the widget's, not the curve's, where they say nothing new.
  if (nodes.size() > 2 && nodes[0].value == nodes[1].value) nodes.erase(nodes.begin());
  if (nodes.size() > 2 && nodes[nodes.size() - 1].value == nodes[nodes.size() - 2].value) nodes.pop_back();
  return modes::TransferFunction(std::move(nodes), interpolation_);
}

void CurveEditor::clear() {
  set_frame({}, across_, 1);
  widget_->setHistogramTable(nullptr);
  set_mark({});
  set_curve(modes::TransferFunction(0.0), Qt::lightGray);
  axes_->clear();
  axes_->setToolTip({});
}

/// The chart within ParaView's widget: it is made with it, and its place is known to it alone.
void CurveEditor::find_chart() {
  if (mark_) return;
  auto* const native = widget_->findChild<QVTKOpenGLNativeWidget*>();  // which of them depends on ParaView's release
  auto* const stereo = widget_->findChild<QVTKOpenGLStereoWidget*>();
  vtkRenderWindow* const window = native ? native->renderWindow() : stereo ? stereo->renderWindow() : nullptr;
  if (!window || !window->GetInteractor()) return;
  vtkRendererCollection& layers = *window->GetRenderers();
  for (int layer = 0; layer < layers.GetNumberOfItems(); ++layer) {
    vtkPropCollection& props = *vtkRenderer::SafeDownCast(layers.GetItemAsObject(layer))->GetViewProps();
    for (int n = 0; n < props.GetNumberOfItems(); ++n) {
      auto* const actor = vtkContextActor::SafeDownCast(props.GetItemAsObject(n));
      vtkContextScene* const scene = actor ? actor->GetScene() : nullptr;
      for (unsigned item = 0; scene && item < scene->GetNumberOfItems(); ++item) {
        auto* const chart = vtkChart::SafeDownCast(scene->GetItem(item));
        if (!chart) continue;
        mark_ = vtkSmartPointer<ChartMark>::New();
        mark_->set_chart(chart);
        scene->AddItem(mark_);
        block_ = std::make_unique<Block>(*this, *window->GetInteractor(), *chart);
        return;
      }
    }
  }
}

void CurveEditor::set_mark(std::optional<double> at) {
  find_chart();
  const double range = counts_.bins.high - counts_.bins.low;
  if (!mark_ || !(range > 0)) return;
  const double part = at ? (*at - counts_.bins.low) / range : -1;
  if (mark_->set_part(part)) widget_->render();
}

/// All nodes by that much from where they were when the drag began, as far as the histogram reaches.
void CurveEditor::shift_to(double by) {
  if (shifted_from_.empty()) {
    const modes::TransferFunction whole = curve();
    shifted_from_.assign(whole.nodes().begin(), whole.nodes().end());
  }
  std::vector<modes::Node> nodes = shifted_from_;
  const double gap = 1e-3 * (counts_.bins.high - counts_.bins.low);
  const double least = counts_.bins.low + gap - nodes.front().at, most = counts_.bins.high - gap - nodes.back().at;
  if (least > most) return;  // it is as wide as the histogram
  for (modes::Node& node : nodes) node.at += std::clamp(by, least, most);
  set_curve(modes::TransferFunction(std::move(nodes), interpolation_), color_);
  move();
}

void CurveEditor::press() {
  held_ = true;
  if (rest_->isActive()) emit finished();  // what keys or numbers have moved
  rest_->stop();
  moved_ = false;
}

/// Once the chart has seen it, too: it may move the curve a last time.
void CurveEditor::let_go() {
  QTimer::singleShot(0, this, [this] {
    held_ = false;
    if (std::exchange(moved_, false)) emit finished();
  });
}

/// A drag ends when the button is let go. Keys and numbers have no button: they end when they rest.
void CurveEditor::move() {
  moved_ = true;
  emit dragged();
  if (!held_) rest_->start();
}

void CurveEditor::curve_modified() {
  if (setting_ || functions_->curve->GetSize() < 2) return;
  show_node();
  move();
}

void CurveEditor::show_node() {
  const vtkIdType node = widget_->currentPoint();
  const bool chosen = node >= 0 && node < functions_->curve->GetSize();
  at_->setEnabled(chosen);
  value_->setEnabled(chosen);
  if (!chosen) return;
  double values[4];
  functions_->curve->GetNodeValue(static_cast<int>(node), values);
  const QSignalBlocker quiet(at_), quiet_too(value_);
  at_->setValue(values[0]);
  value_->setValue(values[1] * top_);
}

void CurveEditor::set_node(double at, double value) {
  const vtkIdType node = widget_->currentPoint();
  vtkPiecewiseFunction& shown = *functions_->curve;
  if (node < 0 || node >= shown.GetSize()) return;
  double values[4], neighbor[4];
  shown.GetNodeValue(static_cast<int>(node), values);
  const double gap = 1e-3 * (counts_.bins.high - counts_.bins.low);
  const bool is_end = node == 0 || node == shown.GetSize() - 1;
  if (!is_end) {
    shown.GetNodeValue(static_cast<int>(node - 1), neighbor);
    at = std::max(at, neighbor[0] + gap);
    shown.GetNodeValue(static_cast<int>(node + 1), neighbor);
    at = std::min(at, neighbor[0] - gap);
    values[0] = at;
  }
  values[1] = std::clamp(value / top_, 0.0, 1.0);
  shown.SetNodeValue(static_cast<int>(node), values);
  widget_->render();
}

bool CurveEditor::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() != QEvent::KeyPress || widget_->currentPoint() < 0) return QWidget::eventFilter(watched, event);
  const auto step = [&](int across, int up) {
    set_node(at_->value() + across * at_->singleStep(), value_->value() + up * value_->singleStep());
    return true;
  };
  switch (static_cast<QKeyEvent*>(event)->key()) {
    case Qt::Key_Left:
      return step(-1, 0);
    case Qt::Key_Right:
      return step(1, 0);
    case Qt::Key_Up:
      return step(0, 1);
    case Qt::Key_Down:
      return step(0, -1);
    default:
      return QWidget::eventFilter(watched, event);
  }
}

}  // namespace palpate::plugin
