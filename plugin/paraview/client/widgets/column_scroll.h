#pragma once

/// A vertically scrolling column that is never narrower than its widgets. While the pointer rests after a press, the
/// pressed widget stays under it even if lines appear above: the column scrolls by as much.

#include <QPoint>
#include <QPointer>
#include <QScrollArea>

namespace palpate::plugin {

class ColumnScroll : public QScrollArea {
 public:
  ColumnScroll(const QString& name, QWidget* column, QWidget* parent);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  int height_of_pressed() const;
  void keep_pressed_in_place();

  QPointer<QWidget> pressed_;
  QPoint pointer_;  // on the screen, at the press
  int height_ = 0;  // of the pressed widget's top in the viewport, pixels
};

}  // namespace palpate::plugin
