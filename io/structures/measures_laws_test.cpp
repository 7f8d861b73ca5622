/// Measures of structures against independent sums and formulas, on lattices and planes that are oblique, tilted,
/// uneven and not square.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <vector>

#include "io/errors.h"
#include "io/structures/contour_planes.h"
#include "io/structures/mask.h"
#include "io/structures/mask_measures.h"
#include "io/structures/structure.h"

namespace palpate::io {
namespace {

class OddLattice {
 public:
  explicit OddLattice(unsigned seed) : random_(seed) {
    Geometry& g = geometry;
    g.dimensions = {12, 9, 7};
    g.direction_i = unit();
    g.direction_j = glm::normalize(glm::cross(unit(), g.direction_i));
    g.spacing_i = between(0.4, 2);
    g.spacing_j = between(0.4, 2);
    const Vec3 normal = glm::cross(g.direction_i, g.direction_j);
    Vec3 at = 150.0 * unit();
    for (int k = 0; k < g.dimensions.z; ++k) {
      g.slice_positions.push_back(at);
      at += between(1, 4) * normal + between(-1, 1) * g.direction_i + between(-1, 1) * g.direction_j;
    }
    g.step = (g.slice_positions.back() - g.slice_positions.front()) / (g.dimensions.z - 1.0);
    g.uniform = false;
  }

  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  int any(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  Vec3 unit() {
    std::normal_distribution<double> normal;
    const double x = normal(random_), y = normal(random_), z = normal(random_);
    return glm::normalize(Vec3(x, y, z));
  }
  Vec3 center(int i, int j, int k) const {
    return geometry.slice_positions[static_cast<std::size_t>(k)] + i * geometry.spacing_i * geometry.direction_i +
           j * geometry.spacing_j * geometry.direction_j;
  }

  Geometry geometry;

 private:
  std::mt19937 random_;
};

void expect_close(const Vec3& a, const Vec3& b, unsigned seed) {
  EXPECT_LT(glm::distance(a, b), 1e-9) << seed;
}

// Each voxel reaches half of the way to the slices beside its own.
TEST(MeasuresLaws, OfAMaskAreThoseOfItsVoxelsThatAreHalfInside) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    OddLattice lattice(seed);
    const Geometry& g = lattice.geometry;
    Mask mask;
    mask.geometry = g;
    mask.low = {3, 2, 1};
    mask.size = {5, 4, 3};
    constexpr std::array<std::uint8_t, 5> shares{0, Mask::half - 1, Mask::half, Mask::half + 1, Mask::full};
    std::uint64_t voxels = 0;
    Vec3 moment(0), low(1e9), high(-1e9);
    double tall = 0;
    const Vec3 normal = glm::cross(g.direction_i, g.direction_j);
    const auto apart = [&](int slice) {  // from a slice to the next; at the ends as on the other side
      const auto at = static_cast<std::size_t>(std::clamp(slice, 0, 5));
      return glm::dot(g.slice_positions[at + 1] - g.slice_positions[at], normal);
    };
    mask.low.z = static_cast<int>(seed % 5);
    for (int k = mask.low.z; k < mask.low.z + 3; ++k) {
      const double below = 0.5 * apart(k - 1), above = 0.5 * apart(k);
      for (int j = 2; j < 6; ++j) {
        for (int i = 3; i < 8; ++i) {
          const std::uint8_t share = shares[static_cast<std::size_t>(lattice.any(5))];
          mask.occupancy.push_back(share);
          if (share < Mask::half) continue;
          const Vec3 at = lattice.center(i, j, k);
          ++voxels;
          tall += below + above;
          moment += (below + above) * (at + 0.5 * (above - below) * normal);
          low = glm::min(low, at);
          high = glm::max(high, at);
        }
      }
    }
    const StructureMeasures measures = measures_of(mask);
    EXPECT_EQ(measures.voxels, voxels);
    EXPECT_FALSE(measures.contours);
    EXPECT_NEAR(measures.volume_mm3, g.spacing_i * g.spacing_j * tall, 1e-9);
    expect_close(measures.centroid_mm, moment / tall, seed);
    expect_close(measures.box_low_mm, low, seed);
    expect_close(measures.box_high_mm, high, seed);
  }
}

TEST(MeasuresLaws, OfAMaskOfNothingAreRefused) {
  Mask mask;
  mask.geometry = OddLattice(1).geometry;
  mask.size = {2, 2, 2};
  mask.occupancy.assign(8, Mask::half - 1);
  EXPECT_THROW(measures_of(mask), DicomError);
}

/// A prism of triangles, each with a smaller one as its hole, drawn either way round and in any order.
TEST(MeasuresLaws, OfContoursAreThoseOfTheirPolygonsWithoutTheirHoles) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    OddLattice lattice(seed);
    const Vec3 u = lattice.geometry.direction_i, v = lattice.geometry.direction_j, n = glm::cross(u, v);
    const double step = lattice.between(1, 5);
    const Vec3 first = 100.0 * lattice.unit();
    const int planes = 4;
    std::vector<Contour> contours;
    Vec3 low(std::numeric_limits<double>::infinity()), high(-low), moment(0);
    double area = 0;
    for (int k = 0; k < planes; ++k) {
      const auto point = [&](double x, double y) { return first + x * u + y * v + k * step * n; };
      // A triangle is known by its corners: half of its legs' product, and their mean.
      const double wide = lattice.between(20, 40), tall = lattice.between(20, 40);
      Contour outer{point(0, 0), point(wide, 0), point(0, tall)};
      Contour hole{point(3, 3), point(3 + 0.2 * wide, 3), point(3, 3 + 0.3 * tall)};
      const double outer_area = wide * tall / 2, hole_area = 0.06 * wide * tall / 2;
      area += outer_area - hole_area;
      for (const Vec3& corner : outer) moment += outer_area / 3 * corner;
      for (const Vec3& corner : hole) moment -= hole_area / 3 * corner;
      for (const Vec3& corner : outer) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
      }
      if (lattice.any(2) == 0) std::reverse(outer.begin(), outer.end());
      if (lattice.any(2) == 0) std::reverse(hole.begin(), hole.end());
      const bool hole_first = lattice.any(2) == 0;
      contours.push_back(hole_first ? hole : outer);
      contours.push_back(hole_first ? outer : hole);
    }
    std::swap(contours[0], contours[5]);
    const StructureMeasures measures = measures_of(contours);
    EXPECT_EQ(measures.contours, 8U);
    EXPECT_FALSE(measures.voxels);
    EXPECT_NEAR(measures.volume_mm3, area * step, 1e-6) << seed;
    EXPECT_LT(glm::distance(measures.centroid_mm, moment / area), 1e-7) << seed;
    expect_close(measures.box_low_mm, low, seed);
    expect_close(measures.box_high_mm, high, seed);
  }
}

/// Squares in each other, drawn either way round and in any order: every second one is a hole.
TEST(MeasuresLaws, IslandsNestToAnyDepth) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    OddLattice lattice(seed);
    const Vec3 u = lattice.geometry.direction_i, v = lattice.geometry.direction_j, n = glm::cross(u, v);
    const double step = lattice.between(1, 5);
    const Vec3 first = 100.0 * lattice.unit();
    std::vector<Contour> contours;
    Vec3 moment(0);
    double area = 0;
    for (int k = 0; k < 3; ++k) {
      const int squares = 1 + lattice.any(7);
      double x = 0, y = 0, half = 40;
      for (int depth = 0; depth < squares; ++depth) {
        const auto point = [&](double i, double j) {
          return first + (x + i * half) * u + (y + j * half) * v + k * step * n;
        };
        Contour square{point(-1, -1), point(1, -1), point(1, 1), point(-1, 1)};
        if (lattice.any(2) == 0) std::reverse(square.begin(), square.end());
        const double signed_area = (depth % 2 == 0 ? 4 : -4) * half * half;
        area += signed_area;
        moment += signed_area * point(0, 0);
        contours.insert(contours.begin() + lattice.any(static_cast<int>(contours.size()) + 1), std::move(square));
        const double smaller = half * lattice.between(0.5, 0.8);
        x += lattice.between(-0.9, 0.9) * (half - smaller);
        y += lattice.between(-0.9, 0.9) * (half - smaller);
        half = smaller;
      }
    }
    const StructureMeasures measures = measures_of(contours);
    EXPECT_NEAR(measures.volume_mm3, area * step, 1e-5) << seed;
    EXPECT_LT(glm::distance(measures.centroid_mm, moment / area), 1e-7) << seed;
  }
}

/// A box around one voxel of the lattice, or around a place up to a voxel beyond it, is not off; beyond that it is.
TEST(MeasuresLaws, ABoxIsOffWhereAllOfItIsMoreThanAVoxelBeyondTheScan) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Geometry g = OddLattice(seed).geometry;
    const auto box_at = [&](const Vec3& index) {
      const Vec3 at = g.to_patient(index);
      return StructureBox{at - 1e-6, at + 1e-6};
    };
    for (int axis = 0; axis < 3; ++axis) {
      for (const double beyond : {0.5, 0.99}) {
        Vec3 before(4, 3, 2), after = before;
        before[axis] = -beyond;
        after[axis] = g.dimensions[axis] - 1 + beyond;
        EXPECT_FALSE(is_off(box_at(before), g)) << seed << ' ' << axis;
        EXPECT_FALSE(is_off(box_at(after), g)) << seed << ' ' << axis;
      }
      for (const double beyond : {1.01, 2.0, 30.0}) {
        Vec3 before(4, 3, 2), after = before;
        before[axis] = -beyond;
        after[axis] = g.dimensions[axis] - 1 + beyond;
        EXPECT_TRUE(is_off(box_at(before), g)) << seed << ' ' << axis;
        EXPECT_TRUE(is_off(box_at(after), g)) << seed << ' ' << axis;
      }
      // One that reaches from outside through all of the scan.
      Vec3 out(4, 3, 2);
      out[axis] = -30;
      StructureBox through = box_at(out);
      const Vec3 in = g.to_patient({5, 4, 3});
      through.low_mm = glm::min(through.low_mm, in);
      through.high_mm = glm::max(through.high_mm, in);
      EXPECT_FALSE(is_off(through, g)) << seed << ' ' << axis;
    }
  }
}

}  // namespace
}  // namespace palpate::io
