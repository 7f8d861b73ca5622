#pragma once

/// Part (a) of `palpate-bench stability`: balances at the ends of what numbers can be, and what each solver made of
/// them. A table on stdout, and as CSV in a folder.

#include <filesystem>

namespace palpate::plugin {

/// Writes extremes.csv into the folder unless it is empty (""). Throws std::runtime_error naming the file.
void run_extremes(const std::filesystem::path& folder);

}  // namespace palpate::plugin
