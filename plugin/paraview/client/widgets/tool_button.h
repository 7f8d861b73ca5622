#pragma once

#include <QBoxLayout>
#include <QToolButton>

namespace palpate::plugin {

/// Adds a button at the end of a row; `act` is called when it is clicked.
template <typename Act>
QToolButton* add_tool_button(QBoxLayout& row, QWidget& parent, const char* name, const QString& text,
                             const QString& tip, Act act) {
  auto* const button = new QToolButton(&parent);
  button->setObjectName(QString::fromLatin1(name));
  button->setText(text);
  button->setToolTip(tip);
  QObject::connect(button, &QToolButton::clicked, &parent, act);
  row.addWidget(button);
  return button;
}

}  // namespace palpate::plugin
