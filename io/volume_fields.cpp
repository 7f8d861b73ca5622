#include "palpate/io/volume_fields.h"

#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "palpate/io/internal/brick_cache.h"
#include "palpate/io/internal/cell.h"
#include "palpate/io/internal/symmetric_eigen.h"

namespace palpate::io {
namespace {

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

Vec3 interpolated_vector(const VectorComponents& vectors, const internal::Cell& cell) noexcept {
  Vec3 along;
  for (int n = 0; n < 3; ++n) {
    along[n] = interpolated_value(*vectors.along[static_cast<std::size_t>(n)], cell);
  }
  return vectors.to_patient * along;
}

Vec3 interpolated_gradient(const internal::Cell& cell, const std::array<glm::vec3, 8>& corners) noexcept {
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

/// The eigenvector of least curvature of the interpolated Hessian; zero where none stands out.
Vec3 tube_direction(const GradientKernel& kernel, const internal::Cell& cell) noexcept {
  std::array<glm::dmat3, 8> corners;
  if (!kernel.hessians_at_cell({cell.first, cell.size}, corners)) {
    return Vec3(0);
  }
  glm::dmat3 hessian(0);
  std::size_t n = 0;
  for (int k = 0; k < cell.size.z; ++k) {
    for (int j = 0; j < cell.size.y; ++j) {
      for (int i = 0; i < cell.size.x; ++i) {
        hessian += cell.weight(i, j, k) * corners[n++];
      }
    }
  }
  const internal::SymmetricEigen eigen = internal::eigen_of_symmetric(hessian);
  constexpr double least_difference = 1e-3;  // of the largest curvature: below it two directions curve alike
  const double difference = std::abs(eigen.values[1]) - std::abs(eigen.values[0]);
  return difference > least_difference * std::abs(eigen.values[2]) ? eigen.vectors[0] : Vec3(0);
}

}  // namespace

FieldSet fields_of(const Volume& volume) noexcept {
  const FieldSet scalar = FieldSet::value | FieldSet::gradient | FieldSet::tube;
  return volume.vectors ? scalar | FieldSet::vector : scalar;
}

VolumeFields::VolumeFields(std::shared_ptr<const Volume> volume, FieldSet wanted, double scale_mm,
                           const FieldOptions& options)
    : volume_(std::move(volume)), available_(wanted) {
  if (!volume_) {
    throw std::invalid_argument("fields need a volume");
  }
  if (!contains(fields_of(*volume_), wanted)) {
    throw std::invalid_argument(
        "a scan offers its value, its gradient and the direction of tubes, and vectors only where velocities were "
        "measured along three directions");
  }
  if ((wanted & (FieldSet::gradient | FieldSet::tube)) != FieldSet::none) {
    kernel_ = std::make_unique<GradientKernel>(volume_, scale_mm);
    if (contains(wanted, FieldSet::gradient) && options.brick_bytes > 0) {
      bricks_ = std::make_unique<internal::BrickCache>(*kernel_, volume_->geometry.dimensions, options.brick_bytes,
                                                       options.background);
    }
  }
}

VolumeFields::~VolumeFields() = default;

Sample VolumeFields::sample(const Vec3& position_mm, FieldSet wanted) const noexcept {
  Sample s;
  internal::Cell cell;
  const Vec3 index = volume_->geometry.to_index(position_mm);
  if (bricks_ && contains(wanted, FieldSet::gradient)) {
    bricks_->move_to(index);  // outside as well: bricks shall be there when the point comes in
  }
  if (!internal::find_cell(*volume_, index, cell)) {
    return s;
  }
  s.inside = true;
  if (contains(wanted, FieldSet::value)) {
    s.value = interpolated_value(*volume_, cell);
  }
  if (contains(wanted & available_, FieldSet::vector)) {
    s.vector = interpolated_vector(*volume_->vectors, cell);
  }
  if (contains(wanted & available_, FieldSet::tube)) {
    s.tube = tube_direction(*kernel_, cell);
  }
  if (contains(wanted & available_, FieldSet::gradient)) {
    std::array<glm::vec3, 8> corners;
    const Block block{cell.first, cell.size};
    s.from_brick = bricks_ && bricks_->read(block, corners);
    if (!s.from_brick) {
      kernel_->at_cell(block, corners);
    }
    s.gradient = interpolated_gradient(cell, corners);
  }
  return s;
}

void VolumeFields::prepare(const Vec3& position_mm, double distance_mm) const {
  if (!bricks_) {
    return;
  }
  const Geometry& g = volume_->geometry;
  const double between = std::abs(glm::dot(g.step, glm::cross(g.direction_i, g.direction_j)));
  const Vec3 reach = distance_mm / Vec3(g.spacing_i, g.spacing_j, between);
  const Vec3 last(g.dimensions - 1);
  const Vec3 index = g.to_index(position_mm);
  const glm::ivec3 low(glm::clamp(index - reach, Vec3(0), last) / static_cast<double>(internal::BrickCache::cells));
  const glm::ivec3 high(glm::clamp(index + reach, Vec3(0), last) / static_cast<double>(internal::BrickCache::cells));
  for (int k = low.z; k <= high.z; ++k) {
    for (int j = low.y; j <= high.y; ++j) {
      for (int i = low.x; i <= high.x; ++i) {
        bricks_->fill(glm::ivec3(i, j, k) * internal::BrickCache::cells);
      }
    }
  }
}

std::size_t VolumeFields::memory_bytes() const noexcept {
  return bricks_ ? bricks_->memory_bytes() : 0;
}

}  // namespace palpate::io
