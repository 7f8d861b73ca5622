#include "io/structures/fraction_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "io/structures/mask_measures.h"

namespace palpate::io {
namespace {

constexpr float not_told = std::numeric_limits<float>::quiet_NaN();

/// The voxels around one, from 0 to 1.
class Around {
 public:
  Around(const ContinuedMask& mask, int i, int j, int k) {
    for (int n = 0; n < 27; ++n) {
      shares_[static_cast<std::size_t>(n)] = share_of(mask, {i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1});
    }
  }
  static double share_of(const ContinuedMask& mask, const glm::ivec3& voxel) {
    return static_cast<double>(mask.occupancy(voxel)) / Mask::full;
  }
  double at(int x, int y, int z) const { return shares_.data()[(z + 1) * 9 + (y + 1) * 3 + x + 1]; }

  /// Where it rises, per mm: differences weighted 1, 2, 1 across them (Youngs).
  Vec3 slope(const Vec3& size) const {
    Vec3 sum(0);
    for (int a = -1; a <= 1; ++a) {
      for (int b = -1; b <= 1; ++b) {
        const double weight = (2 - std::abs(a)) * (2 - std::abs(b));
        sum.x += weight * (at(1, a, b) - at(-1, a, b));
        sum.y += weight * (at(a, 1, b) - at(a, -1, b));
        sum.z += weight * (at(a, b, 1) - at(a, b, -1));
      }
    }
    return sum / (32.0 * size);
  }

 private:
  std::array<double, 27> shares_{};
};

/// Where it is half, going on as it falls: toward the neighbor on the other side, else as on both sides of the voxel.
/// NaN if no neighbor is on the other side. `to_slices`: how far the slices below and above lie, mm.
double distance_to_half(const Around& around, const Vec3& size, const std::array<double, 2>& to_slices) {
  const double above = around.at(0, 0, 0) - 0.5;
  double steep = 0;  // squared, per mm
  bool is_beside_edge = false;
  for (int axis = 0; axis < 3; ++axis) {
    double most = 0, across = 0;
    for (const int side : {-1, 1}) {
      glm::ivec3 to(0);
      to[axis] = side;
      const double there = around.at(to.x, to.y, to.z) - 0.5;
      across += 0.5 * side * there / size[axis];
      const double apart = axis == 2 ? to_slices.at(side < 0 ? 0 : 1) : size[axis];
      if ((there >= 0) != (above >= 0)) most = std::max(most, std::abs(above - there) / apart);
    }
    is_beside_edge = is_beside_edge || most > 0;
    steep += most > 0 ? most * most : across * across;
  }
  return is_beside_edge ? above / std::sqrt(steep) : static_cast<double>(not_told);
}

}  // namespace

double plane_distance(const Vec3& size, const Vec3& normal, double share) {
  Vec3 m = glm::abs(glm::normalize(normal)) * size;
  const double whole = m.x + m.y + m.z;
  m = glm::max(m, Vec3(1e-3 * whole));  // along an axis: as good as
  const double sum = m.x + m.y + m.z;
  const auto cube = [](double x) { return x > 0 ? x * x * x : 0.0; };
  // The fraction below the plane when it has moved this far from the first corner to the last.
  const auto below = [&](double far) {
    return (cube(far) - cube(far - m.x) - cube(far - m.y) - cube(far - m.z) + cube(far - m.x - m.y) +
            cube(far - m.x - m.z) + cube(far - m.y - m.z)) /
           (6 * m.x * m.y * m.z);
  };
  double low = 0, high = sum;
  constexpr int halvings = 24;
  for (int n = 0; n < halvings; ++n) {
    const double middle = 0.5 * (low + high);
    (below(middle) < share ? low : high) = middle;
  }
  return 0.5 * (low + high) - 0.5 * sum;
}

float edge_distance(const ContinuedMask& continued, int i, int j, int k) {
  const double share = Around::share_of(continued, {i, j, k});
  // Less than a sliver, and more than all but one, tell too little.
  constexpr double sliver = 0.08;
  if (share < sliver || share > 1 - sliver) return not_told;
  const Around around(continued, i, j, k);
  const Geometry& geometry = continued.mask().geometry;
  const std::array to_slices{std::max(step_after(geometry, k - 1), 1e-3), std::max(step_after(geometry, k), 1e-3)};
  const Vec3 size(geometry.spacing_i, geometry.spacing_j, (to_slices[0] + to_slices[1]) / 2);
  const bool is_probability = continued.mask().fractions == Mask::Fractions::probability;
  if (is_probability) return static_cast<float>(distance_to_half(around, size, to_slices));
  const Vec3 slope = around.slope(size);
  if (glm::length(slope * size) < 0.1) return not_told;  // thinner than a voxel: no one edge
  return static_cast<float>(plane_distance(size, slope, share));
}

}  // namespace palpate::io
