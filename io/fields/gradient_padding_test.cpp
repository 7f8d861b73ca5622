// Gradients beside padding of any shape: the same bits by all methods, and equal to a plain sum over the neighborhood.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "io/fields/gradient.h"
#include "io/fields/slice_kernel.h"

namespace palpate::io {
namespace {

/// Sums of one voxel's neighborhood as the kernel promises them: rows, then columns, then slices, each from the middle
/// outwards, in single precision. values: of a voxel, 0 if there is none. 1, p, q, w, pp, pq, qq, pw, qw, ww.
class PlainSums {
 public:
  PlainSums(const Volume& volume, const internal::SliceKernel& kernel) : volume_(volume), kernel_(kernel) {}

  std::array<float, 10> at(const glm::ivec3& voxel, const std::function<float(const glm::ivec3&)>& value) const {
    std::array<float, 10> sums{};
    const auto& contributions = kernel_.of_slice[static_cast<std::size_t>(voxel.z)];
    for (std::size_t n = 0; n < contributions.size(); ++n) {
      const internal::Contribution& c = contributions[n];
      const std::array<float, 6> below = plane(voxel, c, value);
      if (!kernel_.straight) {
        add_shifted(below, c, sums);
      } else if (c.paired) {
        add_straight(below, plane(voxel, contributions[n + 1], value), contributions[n + 1], true, sums);
        ++n;
      } else {
        add_straight(below, below, c, false, sums);
      }
    }
    return sums;
  }

 private:
  using Value = std::function<float(const glm::ivec3&)>;

  /// Calls take(even, odd, tap): of two voxels on both sides, or of one.
  void in_order(const internal::Taps& taps, const std::function<void(std::size_t, std::size_t)>& take) const {
    const std::size_t alone = kernel_.straight ? 1 : taps.size();
    for (std::size_t t = 0; t < alone; ++t) take(t, t);
    for (std::size_t t = alone; t + 1 < taps.size(); t += 2) take(t, t + 1);
  }

  /// 1, p, pp of a row.
  std::array<float, 3> row(const glm::ivec3& at, const internal::Taps& taps, const Value& value) const {
    std::array<float, 3> sums{};
    in_order(taps, [&](std::size_t left, std::size_t right) {
      const float l = value(at + glm::ivec3(taps[left].offset, 0, 0));
      const float r = value(at + glm::ivec3(taps[right].offset, 0, 0));
      const bool one = left == right;
      sums[0] += taps[right].weight[0] * (one ? l : r + l);
      sums[1] += taps[right].weight[1] * (one ? l : r - l);
      sums[2] += taps[right].weight[2] * (one ? l : r + l);
    });
    return sums;
  }

  /// 1, p, q, pp, pq, qq of a slice.
  std::array<float, 6> plane(const glm::ivec3& voxel, const internal::Contribution& c, const Value& value) const {
    const internal::Taps& along_i = kernel_.taps_i[static_cast<std::size_t>(c.taps)];
    const internal::Taps& along_j = kernel_.taps_j[static_cast<std::size_t>(c.taps)];
    std::array<float, 6> sums{};
    in_order(along_j, [&](std::size_t left, std::size_t right) {
      const auto l = row({voxel.x, voxel.y + along_j[left].offset, c.slice}, along_i, value);
      const auto r = row({voxel.x, voxel.y + along_j[right].offset, c.slice}, along_i, value);
      const bool one = left == right;
      const auto even = [&](std::size_t n) { return one ? l[n] : r[n] + l[n]; };
      const auto odd = [&](std::size_t n) { return one ? l[n] : r[n] - l[n]; };
      const float* const weight = along_j[right].weight;
      sums[0] += weight[0] * even(0);
      sums[1] += weight[0] * even(1);
      sums[2] += weight[1] * odd(0);
      sums[3] += weight[0] * even(2);
      sums[4] += weight[1] * odd(1);
      sums[5] += weight[2] * even(0);
    });
    return sums;
  }

  static void add_straight(const std::array<float, 6>& b, const std::array<float, 6>& a,
                           const internal::Contribution& c, bool pair, std::array<float, 10>& s) {
    const auto even = [&](std::size_t n) { return pair ? a[n] + b[n] : b[n]; };
    const auto odd = [&](std::size_t n) { return pair ? a[n] - b[n] : b[n]; };
    const float w = c.weight, wz = w * c.offset[2];
    s[0] += w * even(0);
    s[1] += w * even(1);
    s[2] += w * even(2);
    s[3] += wz * odd(0);
    for (std::size_t n = 3; n < 6; ++n) s[n + 1] += w * even(n);
    s[7] += wz * odd(1);
    s[8] += wz * odd(2);
    s[9] += (wz * c.offset[2]) * even(0);
  }

  static void add_shifted(const std::array<float, 6>& b, const internal::Contribution& c, std::array<float, 10>& s) {
    const float w = c.weight, x = c.offset[0], y = c.offset[1], z = c.offset[2];
    const float p = b[1] + x * b[0], q = b[2] + y * b[0];
    s[0] += w * b[0];
    s[1] += w * p;
    s[2] += w * q;
    s[3] += w * (z * b[0]);
    s[4] += w * (b[3] + x * (b[1] + p));
    s[5] += w * (b[4] + y * b[1] + x * q);
    s[6] += w * (b[5] + y * (b[2] + q));
    s[7] += w * (z * p);
    s[8] += w * (z * q);
    s[9] += w * (z * (z * b[0]));
  }

  const Volume& volume_;
  const internal::SliceKernel& kernel_;
};

/// The inverse of a covariance by L D L^T; a pivot below `least` takes its row and column out of it.
glm::dmat3 plain_inverse(const glm::dmat3& c, double least) {
  glm::dmat3 inverse(0), l(1);
  double d[3];
  for (int j = 0; j < 3; ++j) {
    d[j] = c[j][j];
    for (int n = 0; n < j; ++n) d[j] -= l[n][j] * l[n][j] * d[n];
    if (!(d[j] > least)) d[j] = 0;
    for (int i = j + 1; i < 3; ++i) {
      double sum = c[j][i];
      for (int n = 0; n < j; ++n) sum -= l[n][i] * l[n][j] * d[n];
      l[j][i] = d[j] > 0 ? sum / d[j] : 0;
    }
  }
  for (int column = 0; column < 3; ++column) {
    if (d[column] == 0) continue;
    double y[3] = {0, 0, 0};
    for (int i = column; i < 3; ++i) {
      y[i] = i == column ? 1 : 0;
      for (int n = column; n < i; ++n) y[i] -= l[n][i] * y[n];
    }
    for (int i = 2; i >= 0; --i) {
      double x = d[i] > 0 ? y[i] / d[i] : 0;
      for (int n = i + 1; n < 3 && d[i] > 0; ++n) x -= l[i][n] * inverse[column][n];
      inverse[column][i] = x;
    }
  }
  return inverse;
}

/// The slope of the plane that fits the neighborhood best.
class PlainGradient {
 public:
  PlainGradient(const Volume& volume, double scale_mm)
      : volume_(volume), scale_mm_(scale_mm), kernel_(internal::make_slice_kernel(volume.geometry, scale_mm)) {}

  glm::vec3 at(const glm::ivec3& voxel) const {
    const PlainSums sums(volume_, kernel_);
    const auto w = sums.at(voxel, [&](const glm::ivec3& v) { return counts(v) ? 1.0F : 0.0F; });
    const auto s = sums.at(voxel, [&](const glm::ivec3& v) { return counts(v) ? stored(v) : 0.0F; });
    const auto weight = [&](std::size_t n) { return static_cast<double>(w[n]); };
    const double total = weight(0);
    if (!(total > 0)) return glm::vec3(0);
    const glm::dvec3 mean = glm::dvec3(weight(1), weight(2), weight(3)) / total;
    const glm::dmat3 second(weight(4), weight(5), weight(7), weight(5), weight(6), weight(8), weight(7), weight(8),
                            weight(9));
    const glm::dmat3 covariance = second / total - glm::outerProduct(mean, mean);
    const glm::dmat3 to_patient = volume_.slope * kernel_.to_patient;
    const glm::dmat3 slope = to_patient * plain_inverse(covariance, 1e-4 * scale_mm_ * scale_mm_) / total;
    const glm::mat3 m(slope);
    const glm::vec3 constant(-(slope * mean));
    glm::vec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
      gradient[axis] = ((m[0][axis] * s[1] + m[1][axis] * s[2]) + (m[2][axis] * s[3] + constant[axis] * s[0])) + 0.0F;
    }
    return gradient;
  }

 private:
  float stored(const glm::ivec3& v) const {
    const std::size_t at = volume_.offset(v.x, v.y, v.z);
    return std::visit([at](const auto& voxels) { return static_cast<float>(voxels[at]); }, volume_.voxels);
  }
  bool counts(const glm::ivec3& v) const {
    const glm::ivec3 size = volume_.geometry.dimensions;
    return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < size.x && v.y < size.y && v.z < size.z &&
           !volume_.is_padding(v.x, v.y, v.z) && std::isfinite(stored(v));
  }

  const Volume& volume_;
  double scale_mm_;
  internal::SliceKernel kernel_;
};

using IsPadding = std::function<bool(const glm::ivec3&)>;

struct PaddingShape {
  const char* name;
  IsPadding is_padding;
};

std::vector<PaddingShape> padding_shapes(const glm::ivec3& size, unsigned seed) {
  const glm::dvec3 middle = 0.5 * glm::dvec3(size - 1);
  const auto from_middle = [=](const glm::ivec3& v) { return (glm::dvec3(v) - middle) / (0.5 * glm::dvec3(size)); };
  const auto hash = [=](const glm::ivec3& v) {
    std::minstd_rand random(static_cast<unsigned>(1 + v.x + 1000 * (v.y + 1000 * v.z)) + 7919 * seed);
    random.discard(3);
    return random();
  };
  return {{"none", [](const glm::ivec3&) { return false; }},
          {"outside of a circle", [=](const glm::ivec3& v) { return glm::length(glm::dvec2(from_middle(v))) > 0.9; }},
          {"a ball within", [=](const glm::ivec3& v) { return glm::length(from_middle(v)) < 0.6; }},
          {"outside of a ball", [=](const glm::ivec3& v) { return glm::length(from_middle(v)) > 0.8; }},
          {"a voxel in a hundred", [=](const glm::ivec3& v) { return hash(v) % 100 == 0; }},
          {"half of the voxels", [=](const glm::ivec3& v) { return hash(v) % 2 == 0; }},
          {"all but a voxel in a thousand", [=](const glm::ivec3& v) { return hash(v) % 1000 != 0; }},
          {"the first and the last slice", [=](const glm::ivec3& v) { return v.z == 0 || v.z == size.z - 1; }},
          {"every third slice", [=](const glm::ivec3& v) { return v.z % 3 == 1; }},
          {"one column of each row", [=](const glm::ivec3& v) { return v.x == size.x / 2; }},
          {"a step from slice to slice", [=](const glm::ivec3& v) { return v.x < v.z && v.y > size.y / 2; }},
          {"everything", [](const glm::ivec3&) { return true; }}};
}

enum class StoredAs { int16, uint16_of_8_bits, floats, floats_not_finite };
constexpr std::array all_stored_as{StoredAs::int16, StoredAs::uint16_of_8_bits, StoredAs::floats,
                                   StoredAs::floats_not_finite};

Volume padded_volume(const Geometry& geometry, StoredAs storage, const IsPadding& is_padding, unsigned seed) {
  Volume volume;
  volume.geometry = geometry;
  volume.slope = 1.7;
  std::mt19937 random(seed);
  const auto fill = [&]<typename Stored>(std::vector<Stored> voxels, int least, int most, auto padding) {
    const glm::ivec3 size = geometry.dimensions;
    for (int k = 0; k < size.z; ++k) {
      for (int j = 0; j < size.y; ++j) {
        for (int i = 0; i < size.x; ++i) {
          const int value = least + static_cast<int>(random() % static_cast<unsigned>(most - least + 1));
          voxels.push_back(is_padding({i, j, k}) ? padding() : static_cast<Stored>(value));
        }
      }
    }
    volume.voxels = std::move(voxels);
  };
  switch (storage) {
    case StoredAs::int16:
      volume.padding = {-2002.5, -2000};
      fill(std::vector<std::int16_t>(), -1000, 3000,
           [&] { return static_cast<std::int16_t>(-2000 - static_cast<int>(random() % 3)); });
      break;
    case StoredAs::uint16_of_8_bits:
      volume.padding = {0, 0};
      fill(std::vector<std::uint16_t>(), 1, 255, [] { return std::uint16_t{0}; });
      break;
    case StoredAs::floats:
      volume.padding = {-3.1e38, -1e9};
      fill(std::vector<float>(), -1000, 3000, [&] { return random() % 2 == 0 ? -1e9F : -3e38F; });
      break;
    case StoredAs::floats_not_finite:
      fill(std::vector<float>(), -1000, 3000, [&] {
        constexpr auto infinity = std::numeric_limits<float>::infinity();
        return random() % 3 == 0 ? infinity : random() % 2 == 0 ? -infinity : std::nanf("");
      });
      break;
  }
  return volume;
}

/// Slices at any heights, leaning by so much along i and j a mm.
Geometry padded_grid(const glm::ivec3& size, double spacing_mm, double step_mm, double uneven, const glm::dvec2& lean) {
  Geometry g;
  g.dimensions = size;
  g.spacing_i = spacing_mm;
  g.spacing_j = 1.1 * spacing_mm;
  for (int k = 0; k < size.z; ++k) {
    const double height = step_mm * (k + uneven * std::sin(2.4 * k));
    g.slice_positions.emplace_back(lean.x * height, lean.y * height, height);
  }
  g.uniform = uneven == 0;
  g.step = step_mm * Vec3(lean, 1);
  return g;
}

struct PaddedCase {
  const char* name;
  Geometry geometry;
  double scale_mm;
};

/// Of one tile and of three; with few voxels in reach and with many; even, uneven, so uneven that no two slices have
/// the same neighbors and the fits at the edge are not looked up; leaning.
std::vector<PaddedCase> padded_cases() {
  return {{"even", padded_grid({37, 26, 17}, 0.7, 1, 0, {}), 1.5},
          {"wide", padded_grid({530, 9, 5}, 0.8, 1.2, 0, {}), 1.1},
          {"thick", padded_grid({40, 21, 6}, 0.5, 5, 0, {}), 2},
          {"one slice", padded_grid({33, 28, 1}, 1, 3, 0, {}), 2},
          {"uneven", padded_grid({30, 27, 12}, 0.9, 1, 0.2, {}), 1.3},
          {"uneven, its edges unknown", padded_grid({31, 30, 100}, 0.4, 0.8, 0.2, {}), 1.2},
          {"leaning", padded_grid({34, 29, 11}, 0.8, 1, 0, {0, 0.3}), 1.3},
          {"leaning both ways", padded_grid({31, 28, 9}, 0.8, 1, 0, {-0.2, 0.4}), 1.2},
          {"leaning and uneven", padded_grid({31, 28, 10}, 0.9, 1.1, 0.15, {0.1, -0.2}), 1.3}};
}

bool have_same_bits(const glm::vec3& a, const glm::vec3& b) {
  const auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f); };
  return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
}

TEST(GradientBesidePadding, HasTheBitsOfAPlainSumOverTheNeighborhood) {
  unsigned seed = 0;
  int felt = 0;
  for (const PaddedCase& c : padded_cases()) {
    const glm::ivec3 size = c.geometry.dimensions;
    for (const PaddingShape& shape : padding_shapes(size, seed)) {
      const StoredAs storage = all_stored_as[++seed % all_stored_as.size()];
      const auto volume = std::make_shared<const Volume>(padded_volume(c.geometry, storage, shape.is_padding, seed));
      const GradientKernel kernel(volume, c.scale_mm);
      const PlainGradient plain(*volume, c.scale_mm);
      const auto whole = kernel.whole({}, 2);
      std::mt19937 random(seed);
      for (int n = 0; n < 40; ++n) {
        glm::ivec3 voxel;
        for (int axis = 0; axis < 3; ++axis)
          voxel[axis] = static_cast<int>(random() % static_cast<unsigned>(size[axis]));
        const glm::vec3 expected = plain.at(voxel);
        ASSERT_TRUE(have_same_bits(whole[volume->offset(voxel.x, voxel.y, voxel.z)], expected))
            << c.name << ", " << shape.name << ", seed " << seed << ": " << voxel.x << ' ' << voxel.y << ' ' << voxel.z;
        felt += expected != glm::vec3(0);
      }
    }
  }
  EXPECT_GT(felt, 2000);
}

TEST(GradientBesidePadding, HasTheSameBitsAtEveryVoxelAsACellOfIt) {
  unsigned seed = 100;
  for (const PaddedCase& c : padded_cases()) {
    for (const PaddingShape& shape : padding_shapes(c.geometry.dimensions, seed)) {
      const StoredAs storage = all_stored_as[++seed % all_stored_as.size()];
      const auto volume = std::make_shared<const Volume>(padded_volume(c.geometry, storage, shape.is_padding, seed));
      const GradientKernel kernel(volume, c.scale_mm);
      const auto whole = kernel.whole({}, 2);
      const glm::ivec3 size = volume->geometry.dimensions;
      std::array<glm::vec3, 8> cell{};
      for (int k = 0; k < size.z; k += 2 * (1 + size.z / 20)) {
        for (int j = 0; j < size.y; j += 2) {
          for (int i = 0; i < size.x; i += 2) {
            const glm::ivec3 first(i, j, k), of = glm::min(glm::ivec3(2), size - first);
            kernel.at_cell({first, of}, cell);
            for (int n = 0; n < of.x * of.y * of.z; ++n) {
              const glm::ivec3 v = first + glm::ivec3(n % of.x, n / of.x % of.y, n / of.x / of.y);
              ASSERT_TRUE(have_same_bits(whole[volume->offset(v.x, v.y, v.z)], cell[static_cast<std::size_t>(n)]))
                  << c.name << ", " << shape.name << ", seed " << seed << ": " << v.x << ' ' << v.y << ' ' << v.z;
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io
