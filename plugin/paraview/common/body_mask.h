#pragma once

/// Where the patient is in a CT: the largest connected body, with the air in it, without table and headrest.

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "plugin/paraview/common/keep_going.h"

namespace palpate::plugin {

/// On a lattice of every `step`-th voxel.
struct BodyMask {
  glm::ivec3 size{0};
  glm::ivec3 step{1};
  std::vector<std::uint8_t> inside;  ///< 0 or 1, the first index fastest
  bool left_something = false;       ///< whether another solid thing, such as a table, lies around the body

  /// Of a voxel of the scan.
  bool holds(int i, int j, int k) const;
};

/// Whether the mask has one more voxel around the body, to include the slope of the skin.
enum class Rim { none, one_voxel };

/// `value_at`: HU of a voxel. `voxels`, `spacing_mm`: the scan's size and spacing. Coarse voxels are `coarse_mm` apart
/// or a little more. Thin bridges between the body and the table are cut. The largest remaining piece is the body, with
/// its holes and with all pieces within a centimeter of it. Takes some tenths of a second, on any thread. Throws
/// io::Cancelled.
BodyMask body_mask(const std::function<double(int, int, int)>& value_at, const glm::ivec3& voxels,
                   const glm::dvec3& spacing_mm, Rim rim, double coarse_mm = 2, const KeepGoing& keep_going = {});

/// The fraction (0 to 1) of the body's voxels that are as light as lungs: -950 to -600 HU. For a mask without a rim.
double light_part(const BodyMask& body, const std::function<double(int, int, int)>& value_at);

}  // namespace palpate::plugin
