#pragma once

/// Measures how far two outlines are apart. They may lie on different grids: the surfaces that are felt are compared.

#include "io/structures/label_image.h"

namespace palpate::io {

struct ComparedOutline {
  SignedDistance distance;  ///< a true distance up to `true_to_mm` from the surface, and beyond it larger than that
  StructureBox box;         ///< contains the structure, or nearly so
  double true_to_mm = 4;
};

struct OutlineComparison {
  double dice = 0;  ///< twice the shared volume over the sum of both
  /// Mean and others of the distances from all points of each surface to the nearest point of the other one, weighted
  /// by area, both directions together.
  double mean_mm = 0, p95_mm = 0;
  double largest_mm = 0;  ///< of the same distances (Hausdorff)
  Vec3 largest_at_mm{0};  ///< the point that has it
};

/// Throws DicomError if a surface has no point.
OutlineComparison compare_outlines(const ComparedOutline& first, const ComparedOutline& second);

/// The smallest distance between two surfaces, mm. If they intersect: minus the depth of one in the other structure.
double margin_mm(const ComparedOutline& first, const ComparedOutline& second);

}  // namespace palpate::io
