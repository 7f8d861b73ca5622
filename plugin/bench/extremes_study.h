#pragma once

/// Part (a) of `palpate-bench stability`: balances with extreme numbers, and each solver's result. A table on stdout,
/// and as CSV in a folder.

#include <filesystem>

namespace palpate::plugin {

/// Writes extremes.csv into the folder unless its path is empty. Throws std::runtime_error naming the file.
void run_extremes(const std::filesystem::path& folder);

}  // namespace palpate::plugin
