#pragma once

/// The one place where the device's frame (m) and patient space (LPS, mm) meet: a similarity transform.

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

namespace palpate::modes {

using Vec3 = glm::dvec3;

/// patient = center_mm + mm_per_m * rotation * device.
///
/// By default the patient faces the user: right is the patient's left (+x), up is the head (+z), towards the user is
/// anterior (-y), and 1 mm of hand is 1 mm of patient.
struct Workspace {
  Vec3 center_mm{0};                                ///< patient point at the device's origin
  glm::dmat3 rotation{1, 0, 0, 0, 0, 1, 0, -1, 0};  ///< columns: the device's x, y and z axes in patient space
  double mm_per_m = 1000;                           ///< mm of patient per m of hand

  Vec3 to_patient(const Vec3& device_m) const noexcept { return center_mm + mm_per_m * (rotation * device_m); }
  Vec3 to_device(const Vec3& patient_mm) const noexcept {
    return (glm::transpose(rotation) * (patient_mm - center_mm)) / mm_per_m;
  }
  /// Rotates a direction of patient space into the device's frame; lengths are kept.
  Vec3 direction_to_device(const Vec3& direction) const noexcept { return glm::transpose(rotation) * direction; }
  Vec3 direction_to_patient(const Vec3& direction) const noexcept { return rotation * direction; }

  bool operator==(const Workspace&) const = default;
};

/// Between two workspaces: at `part` 0 exactly the first, at 1 exactly the second. In the tick.
Workspace between(const Workspace& from, const Workspace& to, double part) noexcept;

}  // namespace palpate::modes
