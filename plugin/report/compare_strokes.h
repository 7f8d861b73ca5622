#pragma once

/// What two recordings felt on one stroke: the same way through the scan, whenever and however fast it was gone.

#include <filesystem>
#include <string>
#include <vector>

#include "plugin/recording/recorded_session.h"
#include "plugin/report/chart.h"

namespace palpate::plugin {

/// A row a step of the first recording's way.
struct Comparison {
  std::vector<double> along_mm;           ///< way of the first recording's probe
  std::vector<double> first_n, second_n;  ///< force that the stylus was fed, there
  std::vector<double> apart_mm;           ///< farthest that the second one's probe is from the first one's, there
  double most_apart_mm = 0;               ///< of all
  double largest_difference_n = 0;        ///< of the forces
  double largest_difference_at_mm = 0;    ///< where
  double mean_difference_n = 0;           ///< mean of its size over the way
};

/// The two ways are cut into steps of half a millimeter of the hand, which is more than it trembles, so that neither
/// speed nor rest counts, and coupled in their order
/// so that the sum of the squared distances of what is coupled is least (dynamic time warping: Sakoe and Chiba, IEEE
/// Trans. ASSP 26, 1978). The force of a step is the mean over its frames; of several steps of the second that are
/// coupled with one of the first, their mean.
Comparison compare_strokes(const RecordedSession& first, const RecordedSession& second);

/// Both forces, their difference and how far the ways are apart, over the first one's way.
std::vector<Chart> charts_of(const Comparison& comparison, const std::string& first, const std::string& second);

/// A line a step. Throws std::runtime_error naming the file.
void write_csv(const Comparison& comparison, const std::filesystem::path& file);

/// In a sentence or two, for a person.
std::string in_words(const Comparison& comparison);

}  // namespace palpate::plugin
