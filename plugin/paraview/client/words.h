#pragma once

#include <QString>

#include "messages/message.h"

namespace palpate::plugin {

/// A message for the panel.
inline QString words(const Text& text) {
  return QString::fromStdString(text);
}

}  // namespace palpate::plugin
