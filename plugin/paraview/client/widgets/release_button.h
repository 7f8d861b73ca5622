#pragma once

#include <QPushButton>

namespace palpate::plugin {

/// The red button that releases the force. It looks the same everywhere.
inline QPushButton* make_release_button(QWidget& parent, const char* name, const QString& text) {
  auto* const button = new QPushButton(text, &parent);
  button->setObjectName(QString::fromLatin1(name));
  button->setStyleSheet(
      QStringLiteral("QPushButton { background: #b00020; color: white; font-weight: bold; border-radius: 4px }"
                     "QPushButton:pressed { background: #7a0016 }"
                     "QPushButton:disabled { background: palette(mid); color: palette(dark) }"));
  return button;
}

}  // namespace palpate::plugin
