#pragma once

/// A transfer function as a curve over a scan's histogram, with axis titles, a number field for the chosen node, and
/// control by keyboard.

#include <vtkSmartPointer.h>

#include <QColor>
#include <QWidget>

#include <memory>
#include <optional>
#include <vector>

#include "modes/scene/transfer_function.h"
#include "plugin/paraview/client/jobs/scan_study.h"

class QDoubleSpinBox;
class QLabel;
class QTimer;
class pqTransferFunctionWidget;

namespace palpate::plugin {

class ChartMark;

class CurveEditor : public QWidget {
  Q_OBJECT

 public:
  /// `name`: the object name; `across` and `up`: the axis titles, with units.
  CurveEditor(const QString& name, const QString& across, const QString& up, QWidget* parent = nullptr);
  ~CurveEditor() override;

  /// The histogram, its axis title, and the largest value of the curve.
  void set_frame(const Counts& counts, const QString& across, double top);
  /// Replaces the curve; emits no signal.
  void set_curve(const modes::TransferFunction& curve, const QColor& color);
  modes::TransferFunction curve() const;
  /// No histogram and no curve, as without a scan.
  void clear();
  /// A line at the value under the pointer in a slice; none: no line.
  void set_mark(std::optional<double> at);

 signals:
  void dragged();   ///< the curve has moved; the drag may continue
  void finished();  ///< the button was released, or changes by keys and numbers have ended

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  struct Functions;
  class Block;
  void curve_modified();
  void show_node();
  void set_node(double at, double value);
  void show_axes();

  void find_chart();
  void shift_to(double by);
  void press();
  void let_go();
  void move();

  std::unique_ptr<Functions> functions_;
  std::unique_ptr<Block> block_;  // the curve while it is dragged
  vtkSmartPointer<ChartMark> mark_;
  pqTransferFunctionWidget* widget_;
  QLabel* axes_;
  QDoubleSpinBox* at_;
  QDoubleSpinBox* value_;
  QTimer* rest_;
  Counts counts_;
  QString across_, up_;
  double top_ = 1;
  std::vector<modes::Node> shifted_from_;
  QColor color_;
  modes::Interpolation interpolation_ = modes::Interpolation::linear;
  bool setting_ = false;
  bool held_ = false;   // whether the button was pressed in the chart
  bool moved_ = false;  // since the press
};

}  // namespace palpate::plugin
