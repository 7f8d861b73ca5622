#pragma once

/// Parts (b) and (c) of `palpate-bench stability`: over many ticks, and in the hand. Tables on stdout, CSV and pictures
/// in a folder.

#include <filesystem>

namespace palpate::plugin {

struct LoopStudyOptions {
  double seconds = 60;  ///< of each open-loop study
  int hands = 3;        ///< tremors with different seeds
  double hold_s = 2;
};

/// Writes ticks.csv, hand.csv and hand.png into the folder unless its path is empty. Throws std::runtime_error naming a
/// file.
void run_loop_studies(const LoopStudyOptions& options, const std::filesystem::path& folder);

}  // namespace palpate::plugin
