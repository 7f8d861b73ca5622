#include "io/fields/volume_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/ext/vector_common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "io/fields/brick_cache.h"
#include "io/fields/cell.h"
#include "io/fields/cubic_spline.h"
#include "io/fields/low_high.h"
#include "io/fields/symmetric_eigen.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

constexpr FieldSet from_gradients = FieldSet::gradient | FieldSet::low_high;

Vec3 interpolated_vector(const VectorComponents& vectors, const internal::Cell& cell) noexcept {
  Vec3 along;
  for (int n = 0; n < 3; ++n) {
    along[n] = internal::trilinear_value(*vectors.along[static_cast<std::size_t>(n)], cell);
  }
  return vectors.to_patient * along;
}

/// The data of a cell's corners: their gradients and, if a brick holds them, the values on both sides of the boundary.
struct Corners {
  static constexpr int with_sides = 5;  ///< numbers a corner; otherwise 3
  std::array<float, std::size_t{8} * with_sides> numbers;
  int stride = 3;

  const float* at(std::size_t n) const noexcept { return numbers.data() + n * static_cast<std::size_t>(stride); }
  Vec3 gradient(std::size_t n) const noexcept { return {at(n)[0], at(n)[1], at(n)[2]}; }
};

/// Weighted by the strength of the boundary at each corner: in a flat region there are no two sides.
LowHigh interpolated_low_high(const Volume& volume, const internal::Cell& cell, const Corners& corners,
                              double scale_mm) noexcept {
  double low = 0, high = 0, sum = 0;
  std::size_t n = 0;
  for (int k = 0; k < cell.size.z; ++k) {
    for (int j = 0; j < cell.size.y; ++j) {
      for (int i = 0; i < cell.size.x; ++i, ++n) {
        const Vec3 gradient = corners.gradient(n);
        const double weight = cell.weight(i, j, k) * glm::dot(gradient, gradient);
        if (weight > 0) {
          const LowHigh corner = corners.stride == Corners::with_sides
                                     ? LowHigh{corners.at(n)[3], corners.at(n)[4]}
                                     : low_high_at(volume, cell.first + glm::ivec3(i, j, k), gradient, scale_mm);
          low += weight * corner.low;
          high += weight * corner.high;
          sum += weight;
        }
      }
    }
  }
  if (sum > 0) {
    return {static_cast<float>(low / sum), static_cast<float>(high / sum)};
  }
  const auto value = static_cast<float>(internal::trilinear_value(volume, cell));
  return {value, value};
}

Vec3 interpolated_gradient(const internal::Cell& cell, const Corners& corners) noexcept {
  Vec3 gradient(0);
  std::size_t n = 0;
  for (int k = 0; k < cell.size.z; ++k) {
    for (int j = 0; j < cell.size.y; ++j) {
      for (int i = 0; i < cell.size.x; ++i) {
        gradient += cell.weight(i, j, k) * corners.gradient(n++);
      }
    }
  }
  return gradient;
}

/// The eigenvector of least curvature of the interpolated Hessian; zero if none is distinct, or the Hessian is unknown.
Vec3 tube_direction(const internal::Cell& cell, const std::array<GradientKernel::Hessian, 8>& corners) noexcept {
  std::array<double, 6> h{};
  std::size_t n = 0;
  for (int k = 0; k < cell.size.z; ++k) {
    for (int j = 0; j < cell.size.y; ++j) {
      for (int i = 0; i < cell.size.x; ++i, ++n) {
        for (std::size_t m = 0; m < h.size(); ++m) {
          h[m] += cell.weight(i, j, k) * static_cast<double>(corners[n][m]);
        }
      }
    }
  }
  if (!std::isfinite(h[0])) {
    return Vec3(0);
  }
  const internal::SymmetricEigen eigen =
      internal::eigen_of_symmetric(glm::dmat3(h[0], h[1], h[3], h[1], h[2], h[4], h[3], h[4], h[5]));
  constexpr double least_difference = 1e-3;  // of the largest curvature: below it two directions curve alike
  const double difference = std::abs(eigen.values[1]) - std::abs(eigen.values[0]);
  return difference > least_difference * std::abs(eigen.values[2]) ? eigen.vectors[0] : Vec3(0);
}

internal::BrickContent gradients_of(const GradientKernel& kernel) {
  return {3, [&kernel](const Block& block, std::span<float> numbers) {
            std::vector<glm::vec3> gradients(block.voxels());
            kernel.at_block(block, gradients);
            std::memcpy(numbers.data(), gradients.data(), numbers.size_bytes());
          }};
}

internal::BrickContent gradients_and_sides_of(const GradientKernel& kernel, const Volume& volume) {
  return {Corners::with_sides, [&kernel, &volume](const Block& block, std::span<float> numbers) {
            std::vector<glm::vec3> gradients(block.voxels());
            kernel.at_block(block, gradients);
            for (std::size_t n = 0; n < gradients.size(); ++n) {
              const auto at = static_cast<int>(n);
              const glm::ivec3 offset(at % block.size.x, at / block.size.x % block.size.y,
                                      at / block.size.x / block.size.y);
              const glm::vec3& g = gradients[n];
              const LowHigh sides = low_high_at(volume, block.first + offset, Vec3(g), kernel.scale_mm());
              const float of_voxel[Corners::with_sides] = {g.x, g.y, g.z, sides.low, sides.high};
              std::copy(std::begin(of_voxel), std::end(of_voxel), &numbers[n * Corners::with_sides]);
            }
          }};
}

internal::BrickContent hessians_of(const GradientKernel& kernel) {
  return {6, [&kernel](const Block& block, std::span<float> numbers) {
            std::vector<GradientKernel::Hessian> hessians(block.voxels());
            kernel.hessians_at_block(block, hessians);
            std::memcpy(numbers.data(), hessians.data(), numbers.size_bytes());
          }};
}

/// Whole slices.
Block block_of(const SliceRange& slices, const glm::ivec3& size) {
  const int first = std::clamp(slices.first, 0, size.z), last = std::min(slices.last, size.z - 1);
  return {{0, 0, first}, {size.x, size.y, std::max(0, last - first + 1)}};
}

}  // namespace

FieldSet fields_of(const Volume& volume) noexcept {
  const FieldSet scalar = FieldSet::value | FieldSet::gradient | FieldSet::tube | FieldSet::low_high;
  return volume.vectors ? scalar | FieldSet::vector : scalar;
}

VolumeFields::VolumeFields(std::shared_ptr<const Volume> volume, FieldSet wanted, double scale_mm,
                           const FieldOptions& options)
    : volume_(std::move(volume)), available_(wanted), gradient_(options.gradient), value_(options.value) {
  if (!volume_) {
    throw std::logic_error("fields need a volume");
  }
  b_spline_part_ = b_spline_part(volume_->geometry);
  if (!contains(fields_of(*volume_), wanted)) {
    throw InvalidInput(say("scan-offers-its-value"));
  }
  const bool tube = contains(wanted, FieldSet::tube);
  // The spline needs no gradients of voxels; the values on both sides of a boundary do.
  const FieldSet by_voxel = gradient_ == GradientMethod::cubic ? FieldSet::low_high : from_gradients;
  const bool gradients = (wanted & by_voxel) != FieldSet::none;
  if (gradients && gradient_ == GradientMethod::central_differences) {
    kernel_ = std::make_unique<GradientKernel>(volume_, GradientKernel::CentralDifferences{});
    if (tube) hessian_kernel_ = std::make_unique<GradientKernel>(volume_, scale_mm);
  } else if (gradients || tube) {
    kernel_ = std::make_unique<GradientKernel>(volume_, scale_mm);
  }
  const Block region = block_of(options.ahead, volume_->geometry.dimensions);
  if (region.voxels() == 0) return;
  // A Hessian takes twice the memory of a gradient.
  const std::size_t third = options.brick_bytes / 3;
  if (gradients && options.brick_bytes > 0) {
    bricks_ = std::make_unique<internal::BrickCache>(
        contains(wanted, FieldSet::low_high) ? gradients_and_sides_of(*kernel_, *volume_) : gradients_of(*kernel_),
        region, tube ? third : options.brick_bytes, options.background);
  }
  if (tube && options.brick_bytes > 0) {
    tube_bricks_ = std::make_unique<internal::BrickCache>(
        hessians_of(tube_kernel()), region, options.brick_bytes - (gradients ? third : 0), options.background);
  }
}

VolumeFields::~VolumeFields() = default;

void VolumeFields::sample_gradients(const internal::Cell& cell, FieldSet given, Sample& s) const noexcept {
  Corners corners;
  const Block block{cell.first, cell.size};
  corners.stride = contains(available_, FieldSet::low_high) ? Corners::with_sides : 3;
  s.from_brick = bricks_ && bricks_->read(block, corners.numbers);
  if (!s.from_brick) {
    std::array<glm::vec3, 8> gradients;
    kernel_->at_cell(block, gradients);
    corners.stride = 3;
    std::memcpy(corners.numbers.data(), gradients.data(), sizeof gradients);
  }
  if (contains(given, FieldSet::gradient)) {
    s.gradient = interpolated_gradient(cell, corners);
  }
  if (contains(given, FieldSet::low_high)) {
    const LowHigh sides = interpolated_low_high(*volume_, cell, corners, kernel_->scale_mm());
    s.low = sides.low;
    s.high = sides.high;
  }
}

Vec3 VolumeFields::sample_tube(const internal::Cell& cell) const noexcept {
  std::array<GradientKernel::Hessian, 8> corners;
  const Block block{cell.first, cell.size};
  if (!tube_bricks_ || !tube_bricks_->read(block, std::span(corners[0].data(), 6 * corners.size()))) {
    tube_kernel().hessians_at_cell(block, corners);
  }
  return tube_direction(cell, corners);
}

Sample VolumeFields::sample(const Vec3& position_mm, FieldSet wanted) const noexcept {
  Sample s;
  internal::Cell cell;
  const Vec3 index = volume_->geometry.to_index(position_mm);
  FieldSet given = wanted & available_;
  // Outside as well: bricks shall be there when the point comes in.
  if (bricks_ && (given & from_gradients) != FieldSet::none) bricks_->move_to(index);
  if (tube_bricks_ && contains(given, FieldSet::tube)) tube_bricks_->move_to(index);
  if (!internal::find_cell(*volume_, index, cell)) {
    return s;
  }
  s.inside = true;
  if (gradient_ == GradientMethod::cubic && (wanted & (FieldSet::value | given)) != FieldSet::none) {
    const ValueAndGradient spline = cubic_spline(*volume_, cell, b_spline_part_);
    if (contains(wanted, FieldSet::value)) s.value = spline.value;
    if (contains(given, FieldSet::gradient)) s.gradient = spline.gradient;
    given = given & (FieldSet::low_high | FieldSet::tube | FieldSet::vector);
  } else if (contains(wanted, FieldSet::value)) {
    s.value = value_ == ValueMethod::cubic ? cubic_spline_value(*volume_, cell, b_spline_part_)
                                           : internal::trilinear_value(*volume_, cell);
  }
  if (contains(given, FieldSet::vector)) s.vector = interpolated_vector(*volume_->vectors, cell);
  if (contains(given, FieldSet::tube)) s.tube = sample_tube(cell);
  if ((given & from_gradients) != FieldSet::none) sample_gradients(cell, given, s);
  return s;
}

void VolumeFields::prepare(const Vec3& position_mm, double distance_mm) const {
  const Geometry& g = volume_->geometry;
  const double between = std::abs(glm::dot(g.step, glm::cross(g.direction_i, g.direction_j)));
  const Vec3 reach = distance_mm / Vec3(g.spacing_i, g.spacing_j, between);
  const Vec3 last(g.dimensions - 1);
  const Vec3 index = g.to_index(position_mm);
  // NaN becomes 0 here; glm::clamp() would leave it.
  const glm::ivec3 low(glm::fmin(glm::fmax(index - reach, Vec3(0)), last));
  const glm::ivec3 high(glm::fmin(glm::fmax(index + reach, Vec3(0)), last));
  if (bricks_) bricks_->fill(low, high);
  if (tube_bricks_) tube_bricks_->fill(low, high);
}

std::size_t VolumeFields::memory_bytes() const noexcept {
  return (bricks_ ? bricks_->memory_bytes() : 0) + (tube_bricks_ ? tube_bricks_->memory_bytes() : 0);
}

}  // namespace palpate::io
