#include "plugin/paraview/client/layout/views_cover.h"

#include <pqTabbedMultiViewWidget.h>

#include <QEvent>
#include <QMainWindow>
#include <QPainter>

namespace palpate::plugin {

ViewsCover::ViewsCover(QMainWindow& window) : QWidget(&window), views_(window.findChild<pqTabbedMultiViewWidget*>()) {
  setObjectName(QStringLiteral("palpateCover"));
  hide();
  if (!views_ || !views_->parentWidget()) {
    views_.clear();
    return;
  }
  setParent(views_->parentWidget());
  views_->installEventFilter(this);
}

void ViewsCover::set_shown(bool shown) {
  if (!views_) return;
  if (shown) {
    setGeometry(views_->geometry());
    raise();
  }
  setVisible(shown);
}

bool ViewsCover::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize || event->type() == QEvent::Move) setGeometry(views_->geometry());
  return QWidget::eventFilter(watched, event);
}

/// Black, as the views are. Drawn like this it does not count as opaque: what is under it is set up as if it were seen.
void ViewsCover::paintEvent(QPaintEvent* /*event*/) {
  QPainter(this).fillRect(rect(), Qt::black);
}

}  // namespace palpate::plugin
