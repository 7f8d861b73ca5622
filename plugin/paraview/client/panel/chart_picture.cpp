#include "plugin/paraview/client/panel/chart_picture.h"

#include <QMouseEvent>
#include <QPainter>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate::plugin {
namespace {

constexpr ChartStyle axes_style{.left = 50, .right = 8, .top = 6, .bottom = 34, .text = 11, .titled = false};

QImage drawn(const std::vector<Chart>& charts, int width, int height) {
  Canvas canvas(width, height, colors::white);
  draw(canvas, charts, axes_style);
  return QImage(canvas.pixels().data(), width, height, 4 * width, QImage::Format_RGB32).copy();
}

}  // namespace

ChartPicture::ChartPicture(int height, QWidget* parent) : QWidget(parent), panel_height_(height) {
  setMouseTracking(true);
  setFixedHeight(panel_height_);
}

void ChartPicture::show_charts(std::vector<Chart> charts, double length, const QString& words) {
  for (Chart& chart : charts) {
    chart.x.minimum = 0;
    chart.x.maximum = length;
  }
  charts_ = std::move(charts);
  length_ = length;
  words_ = words;
  picture_ = {};
  setFixedHeight(panel_height_ * std::max<int>(1, static_cast<int>(charts_.size())));
  update();
}

void ChartPicture::set_cursor(std::optional<double> x) {
  if (x == cursor_) return;
  cursor_ = x;
  update();
}

void ChartPicture::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  if (charts_.empty()) {
    painter.setPen(palette().color(QPalette::Disabled, QPalette::Text));
    painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap, words_);
    return;
  }
  if (picture_.isNull()) picture_ = drawn(charts_, width(), height());
  painter.drawImage(0, 0, picture_);
  if (cursor_ && length_ > 0) {
    const double x = axes_style.left + *cursor_ / length_ * (width() - axes_style.left - axes_style.right);
    painter.setPen(QColor(0, 0, 0, 160));
    painter.drawLine(QPointF(x, 0), QPointF(x, height()));
  }
}

double ChartPicture::x_at(const QMouseEvent& event) const {
#if QT_VERSION >= QT_VERSION_CHECK(6, 0, 0)
  const double x = event.position().x();
#else
  const double x = event.localPos().x();
#endif
  const double part = (x - axes_style.left) / (width() - axes_style.left - axes_style.right);
  return std::clamp(part, 0.0, 1.0) * length_;
}

void ChartPicture::mousePressEvent(QMouseEvent* event) {
  if (!charts_.empty() && event->button() == Qt::LeftButton) emit picked(x_at(*event));
}

void ChartPicture::mouseMoveEvent(QMouseEvent* event) {
  if (charts_.empty()) return;
  emit pointed(x_at(*event));
  if ((event->buttons() & Qt::LeftButton) != 0) emit picked(x_at(*event));
}

void ChartPicture::leaveEvent(QEvent*) {
  emit pointed(std::numeric_limits<double>::quiet_NaN());
}

void ChartPicture::resizeEvent(QResizeEvent*) {
  picture_ = {};
}

}  // namespace palpate::plugin
