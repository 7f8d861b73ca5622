#include "plugin/paraview/client/panel/force_strip.h"

#include <QCoreApplication>
#include <QPainter>
#include <QPainterPath>

#include <algorithm>

namespace palpate::plugin {
namespace {

constexpr std::size_t kept = 300;  // ten seconds

}  // namespace

double ForceStrip::top_of(double largest_n, double limit_n) {
  constexpr double above_limit = 1.1, small = 1.0 / 3;  // small forces are seen, too
  return largest_n > small * limit_n ? above_limit * limit_n : small * limit_n;
}

ForceStrip::ForceStrip(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("palpateStrip"));
  setMinimumHeight(48);
  setToolTip(QCoreApplication::translate(
      "ForceStrip",
      "Force of the last ten seconds. The dashed line is the limit; it appears when the force reaches a third of it."));
}

void ForceStrip::add(double force_n) {
  const bool was_quiet = std::all_of(forces_.begin(), forces_.end(), [](double n) { return n == 0; });
  forces_.push_back(force_n);
  if (forces_.size() > kept) forces_.pop_front();
  if (!was_quiet || force_n > 0) update();
}

void ForceStrip::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), palette().base());
  const double largest = forces_.empty() ? 0 : *std::max_element(forces_.begin(), forces_.end());
  const double top_n = top_of(largest, limit_n_);
  const auto y_of = [&](double force_n) { return height() - 1 - force_n / top_n * (height() - 4); };
  if (top_n > limit_n_) {
    painter.setPen(QPen(palette().color(QPalette::Dark), 1, Qt::DashLine));
    painter.drawLine(QPointF(0, y_of(limit_n_)), QPointF(width(), y_of(limit_n_)));
  }
  QPainterPath line;
  for (std::size_t n = 0; n < forces_.size(); ++n) {
    const QPointF at(width() - static_cast<double>(forces_.size() - n) / kept * width(), y_of(forces_[n]));
    if (n == 0) {
      line.moveTo(at);
    } else {
      line.lineTo(at);
    }
  }
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(QColor(0, 114, 178), 1.5));
  painter.drawPath(line);
  painter.setPen(palette().color(QPalette::Text));
  QFont small = font();
  small.setPointSizeF(small.pointSizeF() * 0.8);
  painter.setFont(small);
  painter.drawText(rect().adjusted(3, 1, -3, -1), Qt::AlignLeft | Qt::AlignTop,
                   top_n > limit_n_ ? QCoreApplication::translate("ForceStrip", "limit %1 N").arg(limit_n_, 0, 'g', 2)
                                    : QStringLiteral("%1 N").arg(top_n, 0, 'g', 2));
  painter.drawText(rect().adjusted(3, 1, -3, -1), Qt::AlignLeft | Qt::AlignBottom,
                   QCoreApplication::translate("ForceStrip", "10 s"));
}

}  // namespace palpate::plugin
