#include "palpate/io/volume_fields.h"

#include <array>
#include <stdexcept>
#include <utility>

#include "palpate/io/internal/cell.h"

namespace palpate::io {
namespace {

constexpr FieldSet offered = FieldSet::value | FieldSet::gradient;

double interpolated_value(const Volume& volume, const internal::Cell& cell) noexcept {
  const auto stored = [&](const auto& voxels) {
    double sum = 0;
    for (int k = 0; k < cell.size.z; ++k) {
      for (int j = 0; j < cell.size.y; ++j) {
        for (int i = 0; i < cell.size.x; ++i) {
          const double weight = cell.weight(i, j, k);
          if (weight > 0) {  // beside the cell there may be padding that is no number
            const glm::ivec3 v = cell.first + glm::ivec3(i, j, k);
            sum += weight * static_cast<double>(voxels[volume.offset(v.x, v.y, v.z)]);
          }
        }
      }
    }
    return sum;
  };
  return volume.slope * std::visit(stored, volume.voxels) + volume.intercept;
}

Vec3 interpolated_gradient(const GradientKernel& kernel, const internal::Cell& cell) noexcept {
  std::array<glm::vec3, 8> corners;
  kernel.at_cell({cell.first, cell.size}, corners);
  Vec3 gradient(0);
  std::size_t n = 0;
  for (int k = 0; k < cell.size.z; ++k) {
    for (int j = 0; j < cell.size.y; ++j) {
      for (int i = 0; i < cell.size.x; ++i) {
        gradient += cell.weight(i, j, k) * Vec3(corners[n++]);
      }
    }
  }
  return gradient;
}

}  // namespace

VolumeFields::VolumeFields(std::shared_ptr<const Volume> volume, FieldSet wanted, double scale_mm)
    : volume_(std::move(volume)), available_(wanted & offered) {
  if (!volume_) {
    throw std::invalid_argument("fields need a volume");
  }
  if (!contains(offered, wanted)) {
    throw std::invalid_argument("a scan has no vector field; take a mode that reads its value or its gradient");
  }
  if (contains(wanted, FieldSet::gradient)) {
    kernel_ = std::make_unique<GradientKernel>(volume_, scale_mm);
  }
}

VolumeFields::~VolumeFields() = default;

Sample VolumeFields::sample(const Vec3& position_mm, FieldSet wanted) const noexcept {
  Sample s;
  internal::Cell cell;
  if (!internal::find_cell(*volume_, volume_->geometry.to_index(position_mm), cell)) {
    return s;
  }
  s.inside = true;
  if (contains(wanted, FieldSet::value)) {
    s.value = interpolated_value(*volume_, cell);
  }
  if (kernel_ && contains(wanted, FieldSet::gradient)) {
    s.gradient = interpolated_gradient(*kernel_, cell);
  }
  return s;
}

std::size_t VolumeFields::memory_bytes() const noexcept {
  return kernel_ ? sizeof *kernel_ : 0;
}

}  // namespace palpate::io
