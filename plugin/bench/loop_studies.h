#pragma once

/// Parts (b) and (c) of `palpate-bench stability`: over frames, and in the hand. Tables on stdout, CSV and pictures in
/// a folder.

#include <filesystem>

namespace palpate::plugin {

struct LoopStudyOptions {
  double seconds = 60;  ///< of each open-loop study
  int hands = 10;
  double hold_s = 3;
};

/// Writes frames.csv, hand.csv and hand.png into the folder unless it is empty (""). Throws std::runtime_error naming a
/// file.
void run_loop_studies(const LoopStudyOptions& options, const std::filesystem::path& folder);

}  // namespace palpate::plugin
