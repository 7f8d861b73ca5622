#pragma once

/// The charts of the command line in the panel: the same drawing, and what is under the pointer.

#include <QImage>
#include <QWidget>

#include <optional>
#include <vector>

#include "plugin/report/chart.h"

namespace palpate::plugin {

class ChartPicture : public QWidget {
  Q_OBJECT

 public:
  /// `height`: of a panel, pixels.
  explicit ChartPicture(int height, QWidget* parent = nullptr);

  /// Panels below one another over the same x axis, which runs from 0 to `length`; none: an empty place with `words`.
  void show_charts(std::vector<Chart> charts, double length, const QString& words = {});
  /// A line across all panels at x; none takes it away.
  void set_cursor(std::optional<double> x);

 signals:
  /// The x under the pointer; NaN where it has left.
  void pointed(double x);
  /// The x where the left button is down.
  void picked(double x);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  double x_at(const QMouseEvent& event) const;

  int panel_height_;
  std::vector<Chart> charts_;
  double length_ = 0;
  QString words_;
  std::optional<double> cursor_;
  QImage picture_;  // null: to be drawn
};

}  // namespace palpate::plugin
