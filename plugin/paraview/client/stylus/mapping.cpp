#include "plugin/paraview/client/stylus/mapping.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace palpate::plugin {
namespace {

constexpr double smallest_scale = 0.05, largest_scale = 20;

}  // namespace

glm::dmat3 rotation_of(const Eye& eye) {
  const glm::dvec3 towards_user = glm::normalize(eye.position - eye.focus);
  const glm::dvec3 right = glm::normalize(glm::cross(eye.up, towards_user));
  return {right, glm::cross(towards_user, right), towards_user};
}

modes::WorkspaceSettings fit_scan(const modes::WorkspaceSettings& now) {
  return {.center_mm = {}, .rotation = now.rotation, .scale = now.scale, .fit = true};
}

modes::WorkspaceSettings fit_view(const Eye& eye, const glm::dvec3& half_extent_m) {
  const double device_mm = 2e3 * std::max(half_extent_m.y, 1e-3);
  return {.center_mm = eye.focus,
          .rotation = rotation_of(eye),
          .scale = std::clamp(eye.height_mm / device_mm, smallest_scale, largest_scale),
          .fit = false};
}

modes::WorkspaceSettings one_to_one(const modes::Workspace& now) {
  return {.center_mm = now.center_mm, .rotation = now.rotation, .scale = 1, .fit = false};
}

}  // namespace palpate::plugin
