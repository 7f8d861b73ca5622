#pragma once

/// Tissues as hills in the histogram of the values beside edges.

#include <cstddef>
#include <vector>

#include "io/fields/histogram.h"
#include "modes/scene/hills.h"

namespace palpate::modes::internal {

struct TissueHills {
  std::vector<Hill> hills;      ///< in bins; together they cover the range
  std::vector<double> typical;  ///< the value at the top of each hill, scan's unit
};

struct BinRange {
  int first = 0, end = 0;
};

/// The tissues among the edges whose two sides lie in the range and at least `least_bins` apart; the counts are
/// smoothed by a Gaussian of `bandwidth` (scan's unit). In CT, the limit between bone and a softer tissue is nearer to
/// the softer one.
TissueHills tissue_hills(const io::LowHighHistogram& edges, BinRange range, int least_bins, double bandwidth,
                         bool is_ct);

/// Where a boundary is, as a part of the way from one typical value to the other.
double place_between(double low, double high, bool is_ct);

/// A tissue of a CT above this is bone.
inline constexpr double least_bone_hu = 150;

}  // namespace palpate::modes::internal
