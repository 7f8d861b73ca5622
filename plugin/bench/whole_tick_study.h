#pragma once

/// Error against run time of a whole tick, for each method and scale of the gradient and each solver. Shows where a
/// solver's precision no longer matters to the hand.

#include <filesystem>

namespace palpate::plugin {

/// Table on stdout; writes whole-tick.csv and whole-tick.png into the folder unless its path is empty. Throws
/// std::runtime_error naming the file.
void run_whole_tick(const std::filesystem::path& folder);

}  // namespace palpate::plugin
