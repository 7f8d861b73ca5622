#pragma once

/// The positions of a series' voxels in the patient. DICOM patient space: LPS (x to the patient's left, y to the back,
/// z to the head), millimeters. Source: ImagePositionPatient and ImageOrientationPatient of every slice, PixelSpacing;
/// never the gantry-tilt attribute.

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace palpate::io {

using Vec3 = glm::dvec3;

/// Voxel centers: position(i, j, k) = slice_positions[k] + i * spacing_i * direction_i + j * spacing_j * direction_j.
///
/// i counts columns, j rows, k slices; slices ascend along direction_i x direction_j. The step from a slice to the next
/// need not be perpendicular to the slices (gantry tilt), and may vary.
struct Geometry {
  glm::ivec3 dimensions{0};           ///< columns, rows, slices
  Vec3 direction_i{1, 0, 0};          ///< unit: along a row, towards growing column
  Vec3 direction_j{0, 1, 0};          ///< unit: along a column, towards growing row
  double spacing_i = 1;               ///< mm between columns (second value of PixelSpacing)
  double spacing_j = 1;               ///< mm between rows (first value of PixelSpacing)
  std::vector<Vec3> slice_positions;  ///< mm: center of each slice's first voxel

  /// Mean vector from a slice to the next, mm. With a single slice it is the unit normal times the slice's
  /// thickness.
  Vec3 step{0, 0, 1};
  /// Whether every step equals the mean step, within the tolerance that the reader states.
  bool uniform = true;
  /// Intervals k (from slice k to k + 1) where slices are missing: ascending. Nothing is felt inside them.
  std::vector<int> gaps;

  /// Patient position of a continuous voxel index, mm.
  Vec3 to_patient(const Vec3& index) const noexcept;
  /// Continuous voxel index of a patient position (mm). Exact at voxel centers, even if slices are unevenly spaced, and
  /// linear between them. Outside the volume it is extrapolated with the nearest step.
  Vec3 to_index(const Vec3& position_mm) const noexcept;
  /// Whether an index lies within the hull of the voxel centers.
  bool contains(const Vec3& index) const noexcept;
  /// Mean distance between neighboring slices along their normal, mm. With gantry tilt this is less than the length of
  /// `step`.
  double slice_spacing() const noexcept;
  /// Gradient per index step -> gradient per mm in patient space, at slice interval k (the transposed inverse
  /// Jacobian).
  glm::dmat3 index_gradient_to_patient(double k) const noexcept;
};

}  // namespace palpate::io
