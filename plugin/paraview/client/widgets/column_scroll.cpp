#include "plugin/paraview/client/widgets/column_scroll.h"

#include <QCoreApplication>
#include <QCursor>
#include <QEvent>
#include <QLayout>
#include <QScrollBar>

namespace palpate::plugin {

ColumnScroll::ColumnScroll(const QString& name, QWidget* column, QWidget* parent) : QScrollArea(parent) {
  setObjectName(name);
  setWidgetResizable(true);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setFrameShape(QFrame::NoFrame);
  setWidget(column);
  QCoreApplication::instance()->installEventFilter(this);  // a press goes to the child alone
  // Who scrolls has moved it: there it stays.
  connect(verticalScrollBar(), &QScrollBar::valueChanged, this, [this] { height_ = height_of_pressed(); });
}

bool ColumnScroll::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::MouseButtonPress && watched->isWidgetType()) {
    auto* const on = static_cast<QWidget*>(watched);
    pressed_ = widget()->isAncestorOf(on) ? on : nullptr;
    pointer_ = QCursor::pos();
    height_ = height_of_pressed();
  }
  if (watched != widget()) return QScrollArea::eventFilter(watched, event);
  const bool lays_out = event->type() == QEvent::LayoutRequest || event->type() == QEvent::Resize;
  if (lays_out) setMinimumWidth(widget()->minimumSizeHint().width() + verticalScrollBar()->sizeHint().width());
  const bool done = QScrollArea::eventFilter(watched, event);
  if (lays_out) keep_pressed_in_place();
  return done;
}

int ColumnScroll::height_of_pressed() const {
  return pressed_ ? pressed_->mapTo(this, QPoint(0, 0)).y() : 0;
}

void ColumnScroll::keep_pressed_in_place() {
  if (!pressed_ || !pressed_->isVisible() || QCursor::pos() != pointer_) return;
  widget()->layout()->activate();
  const int kept = height_;
  verticalScrollBar()->setValue(verticalScrollBar()->value() + height_of_pressed() - kept);
  height_ = kept;  // also where the column ends before: the next line may make room
}

}  // namespace palpate::plugin
