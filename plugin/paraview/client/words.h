#pragma once

#include <QString>

#include <string>

#include "solver/text/message.h"

namespace palpate::plugin {

/// A message for the panel, in the user's language where the catalogue has it (context "Messages", the table's text
/// with its {}), else in English.
QString words(const Text& text);

/// The name of a tissue that the program gives: "soft tissue". Names from a scene stay as they are.
QString tissue_in_words(const std::string& name);

}  // namespace palpate::plugin
