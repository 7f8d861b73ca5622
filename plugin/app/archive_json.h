#pragma once

/// JSON of archives. It has a header of its own: VTK's JSON and this one cannot be included together.

#include <nlohmann/json_fwd.hpp>

#include "io/archive/archive.h"

namespace palpate::plugin {

/// The connection settings, as in the settings file and in `palpate archive list --json`: name, host, port, AE titles,
/// the method of fetching, and the address for C-MOVE.
nlohmann::ordered_json connection_json(const io::Archive& archive);

}  // namespace palpate::plugin
