#pragma once

/// The distance between two outlines. They may have different grids: their felt surfaces are compared.

#include "io/structures/label_image.h"

namespace palpate::io {

struct ComparedOutline {
  SignedDistance distance;  ///< exact up to `true_to_mm` from the surface; farther away any larger value
  StructureBox box;         ///< contains the structure, perhaps without small parts
  double true_to_mm = 4;
};

struct OutlineComparison {
  double dice = 0;  ///< twice the shared volume over the sum of both
  /// Distances from all points of each surface to the nearest point of the other one, weighted by area, both directions
  /// together.
  double mean_mm = 0, p95_mm = 0;
  double largest_mm = 0;  ///< of the same distances (Hausdorff)
  Vec3 largest_at_mm{0};  ///< the point with that distance
};

/// Throws DicomError if a surface has no point.
OutlineComparison compare_outlines(const ComparedOutline& first, const ComparedOutline& second);

/// The smallest distance between two surfaces; below 0: the depth to which one reaches into the other structure.
double margin_mm(const ComparedOutline& first, const ComparedOutline& second);

}  // namespace palpate::io
