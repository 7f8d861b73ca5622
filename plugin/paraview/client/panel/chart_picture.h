#pragma once

/// Shows the command line's charts in the panel, and reports the pointer's position.

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

  /// Panels below each other with a common x axis from 0 to `length`; without charts, an empty area with `words`.
  void show_charts(std::vector<Chart> charts, double length, const QString& words = {});
  /// A line across all panels at x; none removes it.
  void set_cursor(std::optional<double> x);

 signals:
  /// The x under the pointer; NaN after it has left.
  void pointed(double x);
  /// The x of a press or drag with the left button.
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
  QImage picture_;  // null: must be drawn
};

}  // namespace palpate::plugin
