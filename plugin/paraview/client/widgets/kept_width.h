#pragma once

#include <QAbstractButton>
#include <QStringList>

#include <algorithm>

namespace palpate::plugin {

/// Makes a button as wide as the widest of the texts that it has in turn, so that nothing moves where it changes.
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
