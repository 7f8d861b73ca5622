#include "io/fields/cubic_spline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <type_traits>

#include "io/fields/cell.h"

namespace palpate::io {
namespace {

/// Of the four voxels in a row around t (0 ... 1 between the two in the middle).
struct Basis {
  std::array<double, 4> weight;
  std::array<double, 4> slope;  ///< per voxel
};

Basis basis_at(double t, double part) noexcept {
  const double u = 1 - t;
  const std::array weight_b{u * u * u / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * u * u * u - 6 * u * u + 4) / 6,
                            t * t * t / 6};
  const std::array slope_b{-u * u / 2, (3 * t * t - 4 * t) / 2, -(3 * u * u - 4 * u) / 2, t * t / 2};
  const std::array weight_c{-t * u * u / 2, (3 * t * t * t - 5 * t * t + 2) / 2, (3 * u * u * u - 5 * u * u + 2) / 2,
                            -u * t * t / 2};
  const std::array slope_c{-(3 * t * t - 4 * t + 1) / 2, (9 * t * t - 10 * t) / 2, -(9 * u * u - 10 * u) / 2,
                           (3 * t * t - 2 * t) / 2};
  Basis basis;
  for (std::size_t n = 0; n < 4; ++n) {
    basis.weight[n] = part * weight_b[n] + (1 - part) * weight_c[n];
    basis.slope[n] = part * slope_b[n] + (1 - part) * slope_c[n];
  }
  return basis;
}

/// Four values in a row, some of which may be missing.
struct Line {
  std::array<double*, 4> value;
  std::array<bool, 4> there;
};

/// Continues a line straight. False if neither of the two in the middle is there.
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

/// The slices around a cell that are there: not those beyond the edge, nor on the other side of missing ones.
struct Slices {
  int lowest = 0, highest = 0;
};

Slices slices_around(const Geometry& g, const internal::Cell& cell) noexcept {
  const auto is_gap = [&](int k) { return std::binary_search(g.gaps.begin(), g.gaps.end(), k); };
  const int first = cell.first.z;
  Slices slices{first - 1, first + 2};
  if (is_gap(first - 1)) slices.lowest = first;
  if (is_gap(first + 1)) slices.highest = first + 1;
  if (is_gap(first)) (cell.fraction.z > 0.5 ? slices.lowest : slices.highest) = first + (cell.fraction.z > 0.5 ? 1 : 0);
  return {std::max(slices.lowest, 0), std::min(slices.highest, g.dimensions.z - 1)};
}

/// The 64 stored voxels around a cell, i fastest, minus the middle one, so that rounding makes no edge in a uniform
/// region.
class Stencil {
 public:
  Stencil(const Volume& volume, const internal::Cell& cell) noexcept {
    const glm::ivec3 size = volume.geometry.dimensions;
    const glm::ivec3 first = cell.first - 1;
    const bool within = first.x >= 0 && first.y >= 0 && first.z >= 0 && first.x + 4 <= size.x &&
                        first.y + 4 <= size.y && first.z + 4 <= size.z && !has_gap(volume.geometry, first.z);
    const bool done =
        within && std::visit([&](const auto& voxels) { return read(volume, voxels, first); }, volume.voxels);
    if (!done) {
      read_what_there_is(volume, cell);
    }
    middle_ = values_[(1 * 4 + 1) * 4 + 1];
    for (double& value : values_) value -= middle_;
  }

  double middle() const noexcept { return middle_; }
  /// The row's first voxel.
  const double* row(std::size_t j, std::size_t k) const noexcept { return &values_[(k * 4 + j) * 4]; }

 private:
  /// Whether slices are missing within four from the first.
  static bool has_gap(const Geometry& geometry, int first) noexcept {
    const auto next = std::lower_bound(geometry.gaps.begin(), geometry.gaps.end(), first);
    return next != geometry.gaps.end() && *next < first + 3;
  }

  /// False, and nothing of use is read, where a voxel is padding or no number.
  template <typename Stored>
  bool read(const Volume& volume, const std::vector<Stored>& voxels, const glm::ivec3& first) noexcept {
    auto* value = values_.data();
    for (int k = 0; k < 4; ++k) {
      for (int j = 0; j < 4; ++j) {
        const Stored* const row = voxels.data() + volume.offset(first.x, first.y + j, first.z + k);
        for (int i = 0; i < 4; ++i) {
          *value++ = static_cast<double>(row[i]);
        }
      }
    }
    bool sound = true;
    if (volume.padding) {
      for (const double v : values_) sound = sound && !(v >= volume.padding->first && v <= volume.padding->second);
    }
    if constexpr (std::is_floating_point_v<Stored>) {
      double sum = 0;
      for (const double v : values_) sum += v;
      sound = sound && std::isfinite(sum);
    }
    return sound;
  }

  void read_what_there_is(const Volume& volume, const internal::Cell& cell) noexcept {
    const Geometry& g = volume.geometry;
    const Slices slices = slices_around(g, cell);
    std::array<bool, 64> there;
    for (int n = 0; n < 64; ++n) {
      const glm::ivec3 v = cell.first - 1 + glm::ivec3(n % 4, n / 4 % 4, n / 16);
      const auto at = static_cast<std::size_t>(n);
      there[at] = v.x >= 0 && v.y >= 0 && v.z >= slices.lowest && v.x < g.dimensions.x && v.y < g.dimensions.y &&
                  v.z <= slices.highest && !volume.is_padding(v.x, v.y, v.z);
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
  double middle_ = 0;
};

/// Unevenly spaced slices: the point's position according to the weights, and their step to the next slice.
struct Uneven {
  Vec3 off{0};   ///< mm: to the point from there
  Vec3 step{0};  ///< mm
};

Uneven uneven_at(const Geometry& g, const internal::Cell& cell, const Basis& bk) noexcept {
  const Slices slices = slices_around(g, cell);
  const auto position = [&](int k) {
    const int near = std::clamp(k, slices.lowest, slices.highest);
    const int next = std::clamp(near + (near > k ? 1 : -1), slices.lowest, slices.highest);
    const Vec3& at = g.slice_positions[static_cast<std::size_t>(near)];
    return at + static_cast<double>(std::abs(k - near)) * (at - g.slice_positions[static_cast<std::size_t>(next)]);
  };
  const Vec3 point = position(cell.first.z) + cell.fraction.z * (position(cell.first.z + 1) - position(cell.first.z));
  Uneven uneven{.off = point};
  for (int n = 0; n < 4; ++n) {
    const Vec3 at = position(cell.first.z + n - 1);
    uneven.off -= bk.weight[static_cast<std::size_t>(n)] * at;
    uneven.step += bk.slope[static_cast<std::size_t>(n)] * at;
  }
  return uneven;
}

}  // namespace

Vec3 b_spline_part(const Geometry& geometry) noexcept {
  const Vec3 edges(geometry.spacing_i, geometry.spacing_j, glm::length(geometry.step));
  const double finest = std::min({edges.x, edges.y, edges.z});
  const Vec3 ratio = finest / edges;
  return ratio * ratio;
}

double cubic_spline_value(const Volume& volume, const internal::Cell& cell, const Vec3& part) noexcept {
  if (!volume.geometry.uniform) {
    return cubic_spline(volume, cell, part).value;
  }
  const Stencil stencil(volume, cell);
  const std::array<double, 4> wi = basis_at(cell.fraction.x, part.x).weight;
  const std::array<double, 4> wj = basis_at(cell.fraction.y, part.y).weight;
  const std::array<double, 4> wk = basis_at(cell.fraction.z, part.z).weight;
  // Along a row last: four sums side by side are what processors are good at.
  std::array<double, 4> sum{};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t j = 0; j < 4; ++j) {
      const double weight = wj[j] * wk[k];
      const double* const row = stencil.row(j, k);
      for (std::size_t i = 0; i < 4; ++i) sum[i] += weight * row[i];
    }
  }
  const double above = wi[0] * sum[0] + wi[1] * sum[1] + wi[2] * sum[2] + wi[3] * sum[3];
  return volume.slope * (stencil.middle() + above) + volume.intercept;
}

ValueAndGradient cubic_spline(const Volume& volume, const internal::Cell& cell, const Vec3& part) noexcept {
  const Stencil stencil(volume, cell);
  const Basis bi = basis_at(cell.fraction.x, part.x);
  const Basis bj = basis_at(cell.fraction.y, part.y);
  const Basis bk = basis_at(cell.fraction.z, part.z);
  std::array<double, 4> sum{}, along_j{}, along_k{};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t j = 0; j < 4; ++j) {
      const double weight = bj.weight[j] * bk.weight[k];
      const double slope_j = bj.slope[j] * bk.weight[k];
      const double slope_k = bj.weight[j] * bk.slope[k];
      const double* const row = stencil.row(j, k);
      for (std::size_t i = 0; i < 4; ++i) {
        sum[i] += weight * row[i];
        along_j[i] += slope_j * row[i];
        along_k[i] += slope_k * row[i];
      }
    }
  }
  const auto times = [](const std::array<double, 4>& a, const std::array<double, 4>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  };
  const Vec3 slope(times(bi.slope, sum), times(bi.weight, along_j), times(bi.weight, along_k));
  const Geometry& g = volume.geometry;
  double value = stencil.middle() + times(bi.weight, sum);
  Vec3 gradient;
  if (g.uniform) {
    gradient = g.index_gradient_to_patient(cell.first.z) * slope;
  } else {
    const Uneven uneven = uneven_at(g, cell, bk);
    const glm::dmat3 jacobian(g.spacing_i * g.direction_i, g.spacing_j * g.direction_j, uneven.step);
    gradient = glm::transpose(glm::inverse(jacobian)) * slope;
    value += glm::dot(gradient, uneven.off);
  }
  return {volume.slope * value + volume.intercept, volume.slope * gradient};
}

}  // namespace palpate::io
