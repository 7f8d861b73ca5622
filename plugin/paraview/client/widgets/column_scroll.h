#pragma once

/// A column of widgets that scrolls up and down and is never narrower than they are. What was pressed in it stays under
/// the pointer for as long as the pointer rests, whatever lines appear above: the column scrolls by as much.

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
  QPoint pointer_;  // on the screen, when it was pressed
  int height_ = 0;  // of the pressed widget in the viewport, pixels from above
};

}  // namespace palpate::plugin
