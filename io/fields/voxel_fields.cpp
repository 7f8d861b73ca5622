#include "io/fields/voxel_fields.h"

#include "io/fields/cell.h"
#include "io/fields/cubic_spline.h"

namespace palpate::io {

VoxelFields::VoxelFields(const Volume& volume, ValueMethod value, double scale_mm)
    : volume_(volume), value_(value), b_spline_part_(b_spline_part(volume.geometry)), scale_mm_(scale_mm) {}

std::optional<double> VoxelFields::value(const glm::ivec3& voxel) const noexcept {
  internal::Cell cell;
  if (!internal::find_cell(volume_, Vec3(voxel), cell)) return std::nullopt;
  return value_ == ValueMethod::cubic ? cubic_spline_value(volume_, cell, b_spline_part_)
                                      : internal::trilinear_value(volume_, cell);
}

}  // namespace palpate::io
