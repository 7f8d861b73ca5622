#pragma once

#include <QString>

#include "solver/text/message.h"

namespace palpate::plugin {

/// A message for the panel.
inline QString words(const Text& text) {
  return QString::fromStdString(text);
}

}  // namespace palpate::plugin
