#pragma once

/// Tissues as the hills of the values that edges lie between.

#include <cstddef>
#include <vector>

#include "io/fields/histogram.h"
#include "modes/scene/hills.h"

namespace palpate::modes::internal {

struct TissueHills {
  std::vector<Hill> hills;      ///< in bins; together they cover the range
  std::vector<double> typical;  ///< value of each: the top of its hill, scan's unit
};

struct BinRange {
  int first = 0, end = 0;
};

/// Among the edges whose two sides both lie in the range and at least `least_bins` apart; smoothed by a Gaussian of
/// `bandwidth` (scan's unit). In CT what is softer than bone ends nearer to the softer side.
TissueHills tissue_hills(const io::LowHighHistogram& edges, BinRange range, int least_bins, double bandwidth,
                         bool is_ct);

/// Where a boundary is, of the way from one typical value to the other.
double place_between(double low, double high, bool is_ct);

/// Above, a tissue of a CT is bone.
inline constexpr double least_bone_hu = 150;

}  // namespace palpate::modes::internal
