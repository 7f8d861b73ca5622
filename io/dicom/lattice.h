#pragma once

/// The heights of a stack's slices, and the position of two stacks relative to each other.

#include <vector>

#include "io/dicom/series_source.h"

namespace palpate::io::internal {

/// Heights along the normal, mm, ascending, each once.
struct Lattice {
  std::vector<double> heights;
  double step = 0;    ///< median step; 0 for a single slice
  bool even = false;  ///< nearly all steps equal `step`, or a small multiple of it where slices are missing

  bool operator==(const Lattice&) const = default;
};

/// Heights along the normal of `reference`. Images closer than `same_place` (mm) share a height.
Lattice lattice_of(const SeriesSource& source, const std::vector<SeriesSource::Slice>& slices,
                   const Placement& reference, double same_place);

struct Overlap {
  std::size_t slices = 0;  ///< slices within the other stack's extent, of the stack that has fewer of them
  bool coincide = false;   ///< most of these slices lie at a height of the other stack
  bool shifted = false;    ///< each of the two stacks extends beyond the other
  double distance = 0;     ///< mm, median distance from a slice to the nearest slice of the other stack
};

Overlap overlap_of(const Lattice& a, const Lattice& b, double same_place);

}  // namespace palpate::io::internal
