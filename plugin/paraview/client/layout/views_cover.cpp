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

void ViewsCover::set_words(const QString& words) {
  if (words == words_) return;
  words_ = words;
  update();
}

bool ViewsCover::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize || event->type() == QEvent::Move) setGeometry(views_->geometry());
  return QWidget::eventFilter(watched, event);
}

/// Black, like the views. Drawn like this it does not count as opaque, so the views under it are set up as if visible.
void ViewsCover::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), Qt::black);
  painter.setPen(Qt::lightGray);
  painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap, words_);
}

}  // namespace palpate::plugin
