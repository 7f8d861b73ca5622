#pragma once

/// Edits as JSON, in a file of their own or in a scene. Not installed.

#include <nlohmann/json.hpp>
#include <vector>

#include "io/structures/edit.h"
#include "modes/scene/json_reader.h"

namespace palpate::modes {

/// Throws InvalidInput with the path of the bad key.
std::vector<io::Edit> edits_at(const At& at);

/// Numbers are written so that they read back as the same bits.
nlohmann::ordered_json json_of_edits(const std::vector<io::Edit>& edits);

}  // namespace palpate::modes
