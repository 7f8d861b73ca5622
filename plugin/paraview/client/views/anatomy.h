#pragma once

/// Directions in the patient: a radiologist's planes, and the letters at their edges. Patient space (LPS).

#include <array>
#include <glm/vec3.hpp>
#include <string>

namespace palpate::plugin {

/// "L", "R", "A", "P", "H" or "F" (head, feet) for the direction of a vector; two letters, the nearer one first, if it
/// is more than 10 degrees from an axis.
std::string letters_of(const glm::dvec3& direction);

/// The notation of positions. Radiology's (DICOM's): "L 12.3 P 4.0 H 88.1 mm", the distances to the left (or right, R),
/// to the back (or front, A), to the head (or feet, F). Or that of NIfTI and neuronavigation: "RAS -12.3 -4.0 88.1 mm".
enum class Coordinates { letters, ras };
std::string place_text(const glm::dvec3& place_mm, Coordinates coordinates = Coordinates::letters);

enum class Plane { axial, coronal, sagittal };

/// The direction of an upward turn of the wheel, a unit vector: towards the head in axial slices, the front in coronal
/// ones, the left in sagittal ones.
glm::dvec3 upwards(Plane plane);

/// The orientation of a slice on the screen.
struct Sight {
  int index_axis = 2;         ///< the slice is one of constant index along this axis
  glm::dvec3 along{0, 0, 1};  ///< unit, from the eye into the screen: normal to the slice
  glm::dvec3 up{0, -1, 0};    ///< unit, perpendicular to `along`
};

/// The slice of a lattice with these directions (unit, not in one plane) that is nearest to an anatomical plane, seen
/// as in radiology: axial from the feet with the front up, coronal from the front, sagittal from the left, both with
/// the head up. No two planes get the same index axis.
Sight sight_of(Plane plane, const std::array<glm::dvec3, 3>& directions);

}  // namespace palpate::plugin
