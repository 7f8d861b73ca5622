#pragma once

/// A column of widgets that scrolls up and down and is never narrower than they are.

#include <QEvent>
#include <QScrollArea>
#include <QScrollBar>

namespace palpate::plugin {

class ColumnScroll : public QScrollArea {
 public:
  ColumnScroll(const QString& name, QWidget* column, QWidget* parent) : QScrollArea(parent) {
    setObjectName(name);
    setWidgetResizable(true);
    setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    setFrameShape(QFrame::NoFrame);
    setWidget(column);
  }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override {
    if (watched == widget() && (event->type() == QEvent::LayoutRequest || event->type() == QEvent::Resize)) {
      setMinimumWidth(widget()->minimumSizeHint().width() + verticalScrollBar()->sizeHint().width());
    }
    return QScrollArea::eventFilter(watched, event);
  }
};

}  // namespace palpate::plugin
