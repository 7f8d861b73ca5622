#pragma once

/// Compares the forces of two recordings of one stroke: the same path through the scan, at any time and speed.

#include <filesystem>
#include <string>
#include <vector>

#include "plugin/recording/recorded_session.h"
#include "plugin/report/chart.h"

namespace palpate::plugin {

/// One entry for each step along the first recording's path.
struct Comparison {
  std::vector<double> along_mm;           ///< along the path of the first recording's probe
  std::vector<double> first_n, second_n;  ///< force on the stylus at that step
  std::vector<double> apart_mm;           ///< largest distance from the second probe to the first one at that step
  double most_apart_mm = 0;               ///< largest of these
  double largest_difference_n = 0;        ///< of the forces
  double largest_difference_at_mm = 0;    ///< its place
  double mean_difference_n = 0;           ///< mean of its magnitude along the path
};

/// Both paths are cut into steps of half a millimeter of the hand. That is more than its tremor, so neither speed nor
/// pauses matter. The steps are matched in order, with the least sum of squared distances between matched steps
/// (dynamic time warping: Sakoe and Chiba, IEEE Trans. ASSP 26, 1978). The force of a step is the mean over its ticks.
/// If several steps of the second recording match one of the first, their mean is taken.
Comparison compare_strokes(const RecordedSession& first, const RecordedSession& second);

/// Both forces, their difference, and the distance between the paths, along the first path.
std::vector<Chart> charts_of(const Comparison& comparison, const std::string& first, const std::string& second);

/// One line for each step. Throws std::runtime_error naming the file.
void write_csv(const Comparison& comparison, const std::filesystem::path& file);

/// The result in a sentence or two.
std::string in_words(const Comparison& comparison);

}  // namespace palpate::plugin
