#pragma once

/// Compares what two recordings felt on one stroke: the same way through the scan, at any time and any speed.

#include <filesystem>
#include <string>
#include <vector>

#include "plugin/recording/recorded_session.h"
#include "plugin/report/chart.h"

namespace palpate::plugin {

/// One row for each step of the first recording's way.
struct Comparison {
  std::vector<double> along_mm;           ///< way of the first recording's probe
  std::vector<double> first_n, second_n;  ///< force that the stylus was fed, there
  std::vector<double> apart_mm;           ///< farthest that the second one's probe is from the first one's, there
  double most_apart_mm = 0;               ///< of all
  double largest_difference_n = 0;        ///< of the forces
  double largest_difference_at_mm = 0;    ///< where
  double mean_difference_n = 0;           ///< mean of its size over the way
};

/// Both ways are cut into steps of half a millimeter of the hand. That is more than its tremor, so neither speed nor
/// rest counts. The steps are matched in their order, so that the sum of the squared distances between matched steps is
/// least (dynamic time warping: Sakoe and Chiba, IEEE Trans. ASSP 26, 1978). The force of a step is the mean over its
/// ticks. If several steps of the second recording match one of the first, their mean is taken.
Comparison compare_strokes(const RecordedSession& first, const RecordedSession& second);

/// Both forces, their difference and how far the ways are apart, over the first one's way.
std::vector<Chart> charts_of(const Comparison& comparison, const std::string& first, const std::string& second);

/// A line a step. Throws std::runtime_error naming the file.
void write_csv(const Comparison& comparison, const std::filesystem::path& file);

/// The result in a sentence or two.
std::string in_words(const Comparison& comparison);

}  // namespace palpate::plugin
