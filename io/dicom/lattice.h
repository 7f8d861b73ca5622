#pragma once

/// The heights of a stack's slices, and the relation of two stacks.

#include <vector>

#include "io/dicom/series_source.h"

namespace palpate::io::internal {

/// Distinct heights along the normal, mm, ascending.
struct Lattice {
  std::vector<double> heights;
  double step = 0;    ///< the median step; 0 if there is one slice
  bool even = false;  ///< nearly all steps are equal to `step`, or to a small multiple of it where slices are missing

  bool operator==(const Lattice&) const = default;
};

/// Heights along the normal of `reference`. Heights that differ by less than `same_place` (mm) count as one.
Lattice lattice_of(const SeriesSource& source, const std::vector<SeriesSource::Slice>& slices,
                   const Placement& reference, double same_place);

struct Overlap {
  std::size_t slices = 0;  ///< of the stack with fewer slices inside the other's extent
  bool coincide = false;   ///< most of these lie at the height of a slice of the other stack
  bool shifted = false;    ///< each stack extends beyond the other
  double distance = 0;     ///< mm, the median distance from a slice to the nearest of the other stack
};

Overlap overlap_of(const Lattice& a, const Lattice& b, double same_place);

}  // namespace palpate::io::internal
