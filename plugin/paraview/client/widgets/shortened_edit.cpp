#include "plugin/paraview/client/widgets/shortened_edit.h"

#include <QFontMetrics>
#include <QPainter>
#include <QStyle>
#include <QStyleOptionFrame>

namespace palpate::plugin {

ShortenedEdit::ShortenedEdit(QWidget* parent) : QLineEdit(parent) {
  setFrame(false);
}

void ShortenedEdit::paintEvent(QPaintEvent* event) {
  constexpr int beside = 2;  // QLineEdit's own margin on either side
  const QRect room = contentsRect().adjusted(beside, 0, -beside, 0);
  const QString shown = fontMetrics().elidedText(text(), Qt::ElideMiddle, room.width());
  if (hasFocus() || shown == text()) return QLineEdit::paintEvent(event);
  QPainter painter(this);
  QStyleOptionFrame frame;
  initStyleOption(&frame);
  style()->drawPrimitive(QStyle::PE_PanelLineEdit, &frame, &painter, this);
  painter.setPen(palette().color(isEnabled() ? QPalette::Active : QPalette::Disabled, QPalette::Text));
  painter.drawText(room, static_cast<int>(Qt::AlignLeft | Qt::AlignVCenter), shown);
}

}  // namespace palpate::plugin
