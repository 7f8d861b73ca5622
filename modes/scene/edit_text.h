#pragma once

/// Edits of a structure's outline as text: {"version": 1, "edits": [{"type": "trace", "points_mm": [[x, y, z], ...],
/// ...}, ...]}. The keys are in modes/README.md.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/structures/edit.h"

namespace palpate::modes {

inline constexpr int edit_text_version = 1;

/// Reads edits, in their order. An edit's values are checked when it is applied (io/structures/edits.h). `source` names
/// the text in messages (a file's name). Throws InvalidInput with the source and the path of the bad key: "mend.json:
/// edits[1].type: there is no "cut"; there are: trace, add, ...".
std::vector<io::Edit> edits_from_json(std::string_view text, const std::string& source);

/// The same text again; every number reads back as the same bits.
std::string to_json(const std::vector<io::Edit>& edits);

/// The edits in a file. Throws InvalidInput that names the file.
std::vector<io::Edit> load_edits(const std::filesystem::path& file);

}  // namespace palpate::modes
