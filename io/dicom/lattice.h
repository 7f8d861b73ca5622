#pragma once

/// The heights of a stack's slices, and how two stacks lie to each other.

#include <vector>

#include "io/dicom/series_source.h"

namespace palpate::io::internal {

/// Heights along the normal, mm, ascending, each once.
struct Lattice {
  std::vector<double> heights;
  double step = 0;    ///< the median one; 0 where there is one slice
  bool even = false;  ///< nearly all steps are that one, or a few times it where slices are missing

  bool operator==(const Lattice&) const = default;
};

/// Heights along the normal of `reference`; what is closer than `same_place` (mm) is one height.
Lattice lattice_of(const SeriesSource& source, const std::vector<SeriesSource::Slice>& slices,
                   const Placement& reference, double same_place);

struct Overlap {
  std::size_t slices = 0;  ///< of the one that has fewer of them within the other's extent
  bool coincide = false;   ///< most of these lie where the other has one, too
  bool shifted = false;    ///< each of the two reaches beyond the other
  double distance = 0;     ///< mm, the median from a slice to the other's nearest
};

Overlap overlap_of(const Lattice& a, const Lattice& b, double same_place);

}  // namespace palpate::io::internal
