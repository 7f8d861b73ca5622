#include "io/dicom/lattice.h"

#include <algorithm>
#include <cmath>

#include "io/dicom/stacking.h"
#include "io/quantile.h"

namespace palpate::io::internal {
namespace {

bool is_even(const std::vector<double>& steps, double usual) {
  constexpr double tolerance = 0.1;
  constexpr double most_missing = 4;
  const auto regular = std::count_if(steps.begin(), steps.end(), [&](double step) {
    const double times = std::round(step / usual);
    return times >= 1 && times <= most_missing && std::abs(step - times * usual) <= tolerance * usual;
  });
  return 5 * static_cast<std::size_t>(regular) >= 4 * steps.size();
}

// From each height of `a` that lies within b's extent to the nearest of b.
std::vector<double> distances(const Lattice& a, const Lattice& b, double same_place) {
  std::vector<double> found;
  for (const double height : a.heights) {
    if (height < b.heights.front() - same_place || height > b.heights.back() + same_place) continue;
    const auto above = std::lower_bound(b.heights.begin(), b.heights.end(), height);
    double nearest = above != b.heights.end() ? *above - height : height - b.heights.back();
    if (above != b.heights.begin()) nearest = std::min(nearest, height - *(above - 1));
    found.push_back(nearest);
  }
  return found;
}

}  // namespace

Lattice lattice_of(const SeriesSource& source, const std::vector<SeriesSource::Slice>& slices,
                   const Placement& reference, double same_place) {
  std::vector<double> all;
  all.reserve(slices.size());
  for (const auto& slice : slices) all.push_back(height_of(source.plane_of(slice).placement->position, reference));
  std::sort(all.begin(), all.end());
  Lattice lattice;
  for (const double height : all) {
    if (lattice.heights.empty() || height - lattice.heights.back() > same_place) lattice.heights.push_back(height);
  }
  std::vector<double> steps;
  for (std::size_t k = 1; k < lattice.heights.size(); ++k) {
    steps.push_back(lattice.heights[k] - lattice.heights[k - 1]);
  }
  lattice.step = quantile(steps, 0.5);
  lattice.even = !steps.empty() && is_even(steps, lattice.step);
  return lattice;
}

Overlap overlap_of(const Lattice& a, const Lattice& b, double same_place) {
  const std::vector<double> from_a = distances(a, b, same_place);
  const std::vector<double> from_b = distances(b, a, same_place);
  Overlap overlap;
  overlap.slices = std::min(from_a.size(), from_b.size());
  if (overlap.slices == 0) return overlap;
  const auto& fewer = from_a.size() <= from_b.size() ? from_a : from_b;
  const auto at_one = std::count_if(fewer.begin(), fewer.end(), [&](double d) { return d <= same_place; });
  overlap.coincide = 2 * static_cast<std::size_t>(at_one) >= fewer.size();
  overlap.shifted = from_a.size() < a.heights.size() && from_b.size() < b.heights.size();
  overlap.distance = quantile(fewer, 0.5);
  return overlap;
}

}  // namespace palpate::io::internal
