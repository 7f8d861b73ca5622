#pragma once

/// Error against run time of a whole tick: how the gradient is taken, at which scale, and by which solver. Says where
/// a solver's precision stops mattering to the hand.

#include <filesystem>

namespace palpate::plugin {

/// Table on stdout; writes whole-tick.csv and whole-tick.png into the folder unless it is empty (""). Throws
/// std::runtime_error naming the file.
void run_whole_tick(const std::filesystem::path& folder);

}  // namespace palpate::plugin
