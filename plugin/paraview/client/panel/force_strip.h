#pragma once

/// A strip chart of the force in the last seconds.

#include <QWidget>

#include <deque>

namespace palpate::plugin {

class ForceStrip : public QWidget {
 public:
  explicit ForceStrip(QWidget* parent = nullptr);

  /// N: the largest force since the last call.
  void add(double force_n);
  /// The force at the strip's upper edge, N.
  static double top_of(double largest_n, double limit_n);
  /// A line at the force limit, N.
  void set_limit(double limit_n) { limit_n_ = limit_n; }
  QSize sizeHint() const override { return {200, 56}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::deque<double> forces_;
  double limit_n_ = 3;
};

}  // namespace palpate::plugin
