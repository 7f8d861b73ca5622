#pragma once

#include <QAbstractButton>
#include <QStringList>

#include <algorithm>

namespace palpate::plugin {

/// Makes a button as wide as the widest of its alternative texts, so that nothing moves when the text changes.
inline void keep_width(QAbstractButton& button, const QStringList& texts) {
  const QString text = button.text();
  int width = 0;
  for (const QString& one : texts) {
    button.setText(one);
    width = std::max(width, button.sizeHint().width());
  }
  button.setText(text);
  button.setMinimumWidth(width);
}

}  // namespace palpate::plugin
