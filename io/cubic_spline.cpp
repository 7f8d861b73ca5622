#include "palpate/io/cubic_spline.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palpate/io/internal/cell.h"

namespace palpate::io {
namespace {

struct Basis {
  std::array<double, 4> weight;
  std::array<double, 4> slope;  ///< per voxel
};

Basis basis_at(double t) noexcept {
  const double u = 1 - t;
  return {{u * u * u / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * u * u * u - 6 * u * u + 4) / 6, t * t * t / 6},
          {-u * u / 2, (3 * t * t - 4 * t) / 2, -(3 * u * u - 4 * u) / 2, t * t / 2}};
}

/// Four values in a row, of which some may not be there.
struct Line {
  std::array<double*, 4> value;
  std::array<bool, 4> there;
};

/// Continues a line straight. False where neither of the two in the middle is there.
bool complete(const Line& line) noexcept {
  const auto& [v, there] = line;
  if (!there[1] && !there[2]) {
    return false;
  }
  if (!there[2]) *v[2] = there[0] ? 2 * *v[1] - *v[0] : *v[1];
  if (!there[1]) *v[1] = there[3] ? 2 * *v[2] - *v[3] : *v[2];
  if (!there[0]) *v[0] = 2 * *v[1] - *v[2];
  if (!there[3]) *v[3] = 2 * *v[2] - *v[1];
  return true;
}

/// The 64 voxels around a cell, i fastest.
class Stencil {
 public:
  Stencil(const Volume& volume, const internal::Cell& cell) noexcept {
    const glm::ivec3 size = volume.geometry.dimensions;
    const glm::ivec3 first = cell.first - 1;
    const bool within = first.x >= 0 && first.y >= 0 && first.z >= 0 && first.x + 4 <= size.x &&
                        first.y + 4 <= size.y && first.z + 4 <= size.z;
    const bool sound =
        !volume.padding && volume.geometry.gaps.empty() && !std::holds_alternative<std::vector<float>>(volume.voxels);
    if (within && sound) {
      std::visit([&](const auto& voxels) { read(volume, voxels, first); }, volume.voxels);
    } else {
      read_what_there_is(volume, cell);
    }
  }

  double at(std::size_t i, std::size_t j, std::size_t k) const noexcept { return values_[(k * 4 + j) * 4 + i]; }

 private:
  template <typename Stored>
  void read(const Volume& volume, const std::vector<Stored>& voxels, const glm::ivec3& first) noexcept {
    auto* value = values_.data();
    for (int k = 0; k < 4; ++k) {
      for (int j = 0; j < 4; ++j) {
        const Stored* const row = voxels.data() + volume.offset(first.x, first.y + j, first.z + k);
        for (int i = 0; i < 4; ++i) {
          *value++ = static_cast<double>(row[i]);
        }
      }
    }
  }

  void read_what_there_is(const Volume& volume, const internal::Cell& cell) noexcept {
    const Geometry& g = volume.geometry;
    const auto is_gap = [&](int k) { return std::binary_search(g.gaps.begin(), g.gaps.end(), k); };
    // Slices on the other side of a gap from the point are not there.
    int lowest = cell.first.z - 1;
    int highest = cell.first.z + 2;
    if (is_gap(cell.first.z - 1)) lowest = cell.first.z;
    if (is_gap(cell.first.z + 1)) highest = cell.first.z + 1;
    if (is_gap(cell.first.z))
      (cell.fraction.z > 0.5 ? lowest : highest) = cell.first.z + (cell.fraction.z > 0.5 ? 1 : 0);
    std::array<bool, 64> there;
    for (int n = 0; n < 64; ++n) {
      const glm::ivec3 v = cell.first - 1 + glm::ivec3(n % 4, n / 4 % 4, n / 16);
      const auto at = static_cast<std::size_t>(n);
      there[at] = v.x >= 0 && v.y >= 0 && v.z >= std::max(lowest, 0) && v.x < g.dimensions.x && v.y < g.dimensions.y &&
                  v.z <= std::min(highest, g.dimensions.z - 1) && !volume.is_padding(v.x, v.y, v.z);
      values_[at] =
          there[at] ? std::visit(
                          [&](const auto& voxels) { return static_cast<double>(voxels[volume.offset(v.x, v.y, v.z)]); },
                          volume.voxels)
                    : 0;
      there[at] = there[at] && std::isfinite(values_[at]);
    }
    for (const std::size_t stride : {1U, 4U, 16U}) {
      for (std::size_t n = 0; n < 64; ++n) {
        if (n / stride % 4 != 0) continue;
        Line line;
        for (std::size_t m = 0; m < 4; ++m) {
          line.value[m] = &values_[n + m * stride];
          line.there[m] = there[n + m * stride];
        }
        const bool done = complete(line);
        for (std::size_t m = 0; m < 4; ++m) there[n + m * stride] = done;
      }
    }
  }

  std::array<double, 64> values_;
};

}  // namespace

ValueAndGradient cubic_b_spline(const Volume& volume, const internal::Cell& cell) noexcept {
  const Stencil stencil(volume, cell);
  const std::array<Basis, 3> basis{basis_at(cell.fraction.x), basis_at(cell.fraction.y), basis_at(cell.fraction.z)};
  double value = 0;
  Vec3 slope(0);
  for (std::size_t k = 0; k < 4; ++k) {
    double plane = 0;
    Vec3 in_plane(0);
    for (std::size_t j = 0; j < 4; ++j) {
      double row = 0;
      double along = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        row += basis[0].weight[i] * stencil.at(i, j, k);
        along += basis[0].slope[i] * stencil.at(i, j, k);
      }
      plane += basis[1].weight[j] * row;
      in_plane += Vec3(basis[1].weight[j] * along, basis[1].slope[j] * row, 0);
    }
    value += basis[2].weight[k] * plane;
    slope += basis[2].weight[k] * in_plane + Vec3(0, 0, basis[2].slope[k] * plane);
  }
  return {volume.slope * value + volume.intercept,
          volume.slope * (volume.geometry.index_gradient_to_patient(cell.first.z) * slope)};
}

}  // namespace palpate::io
