#pragma once

/// Whether touch helps a simulated hand to correct an outline. The hand traces the true edge on a screen, with tremor,
/// drift and the error of aiming at a pixel: once with a stylus without forces, and once pressed into the scan's edge,
/// where the proxy's path is the trace. No claim about people.

#include <filesystem>
#include <string>

namespace palpate::plugin {

struct TouchStudyOptions {
  int hands = 3;  ///< seeded ones, for each error
};

/// Prints a table, draws the distances to the truth into `folder` if there is one, and returns the table as CSV.
std::string study_touch(const TouchStudyOptions& options, const std::filesystem::path& folder);

}  // namespace palpate::plugin
