#pragma once

/// Which way is which: the planes that a radiologist looks at, and the letters at their edges. Patient space (LPS).

#include <array>
#include <glm/vec3.hpp>
#include <string>

namespace palpate::plugin {

/// "L", "R", "A", "P", "H" or "F" (head, feet) for the direction that a vector points to; two letters, the nearer
/// first, where it is more than 10 degrees off.
std::string letters_of(const glm::dvec3& direction);

/// How places are written. DICOM's and radiology's own, "L 12.3 P 4.0 H 88.1 mm": how far to the left (or right, R),
/// to the back (or front, A), to the head (or feet, F). Or that of NIfTI and neuronavigation, "RAS -12.3 -4.0 88.1 mm".
enum class Coordinates { letters, ras };
std::string place_text(const glm::dvec3& place_mm, Coordinates coordinates = Coordinates::letters);

enum class Plane { axial, coronal, sagittal };

/// Where a turn of the wheel leads, a unit vector: towards the head in axial slices, the front in coronal ones, the
/// left in sagittal ones.
glm::dvec3 upwards(Plane plane);

/// How a slice is looked at.
struct Sight {
  int index_axis = 2;         ///< the slice is one of constant index along this axis
  glm::dvec3 along{0, 0, 1};  ///< unit, from the eye into the screen: normal to the slice
  glm::dvec3 up{0, -1, 0};    ///< unit, perpendicular to `along`
};

/// The slice of a lattice with these directions (unit, not in one plane) that is nearest to an anatomical plane, seen
/// as radiology does: axial from the feet with the front up, coronal from the front, sagittal from the left, the head
/// up. No two planes get the same index axis.
Sight sight_of(Plane plane, const std::array<glm::dvec3, 3>& directions);

}  // namespace palpate::plugin
