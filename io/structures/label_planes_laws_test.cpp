// The planes of a mask, on lattices that are at once oblique, tilted, uneven and not square: the node of each voxel,
// and the distance of every node from the nearest voxel inside and outside.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <tuple>
#include <vector>

#include "io/structures/fraction_edges.h"
#include "io/structures/label_planes.h"

namespace palpate::io {
namespace {

struct OddMask {
  std::mt19937 random;
  Mask mask;

  OddMask(unsigned seed, bool uneven, bool tilted) : random(seed) {
    Geometry& g = mask.geometry;
    g.dimensions = {9, 8, 7};
    g.direction_i = unit();
    g.direction_j = glm::normalize(glm::cross(unit(), g.direction_i));
    g.spacing_i = between(0.7, 2.2);
    g.spacing_j = between(0.7, 2.2);
    const Vec3 normal = glm::cross(g.direction_i, g.direction_j);
    const double apart = between(0.8, 3), slide_i = between(-0.5, 0.5), slide_j = between(-0.5, 0.5);
    Vec3 at = 60.0 * unit();
    for (int k = 0; k < g.dimensions.z; ++k) {
      g.slice_positions.push_back(at);
      at += apart * (uneven ? between(1, 1.6) : 1.0) * normal;
      if (tilted) at += slide_i * g.direction_i + slide_j * g.direction_j;
    }
    g.step = (g.slice_positions.back() - g.slice_positions.front()) / (g.dimensions.z - 1.0);
    g.uniform = !uneven;
    // At an end of the lattice, or not.
    mask.size = {4, 3, 3};
    for (int axis = 0; axis < 3; ++axis) {
      mask.low[axis] = static_cast<int>(random() % 3) * (g.dimensions[axis] - mask.size[axis]) / 2;
    }
    for (int n = 0; n < 36; ++n) mask.occupancy.push_back(static_cast<std::uint8_t>(random() % 255));
    mask.occupancy[7] = Mask::full;
  }
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  Vec3 unit() {
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    return glm::normalize(Vec3(x, y, z));
  }
  /// Of any voxel; beyond the lattice it goes on by its mean step.
  Vec3 center(const glm::ivec3& voxel) const {
    const Geometry& g = mask.geometry;
    const int held = std::clamp(voxel.z, 0, g.dimensions.z - 1);
    return g.slice_positions[static_cast<std::size_t>(held)] + static_cast<double>(voxel.z - held) * g.step +
           voxel.x * g.spacing_i * g.direction_i + voxel.y * g.spacing_j * g.direction_j;
  }
  /// As it is at the edge of the lattice where it is beyond.
  bool inside(const glm::ivec3& voxel) const {
    const glm::ivec3 at = glm::clamp(voxel, glm::ivec3(0), mask.geometry.dimensions - 1), in = at - mask.low;
    if (std::min({in.x, in.y, in.z}) < 0 || in.x > 3 || in.y > 2 || in.z > 2) return false;
    return mask.occupancy[static_cast<std::size_t>((in.z * 3 + in.y) * 4 + in.x)] >= Mask::half;
  }
  double least_step() const {
    const Geometry& g = mask.geometry;
    const Vec3 normal = glm::cross(g.direction_i, g.direction_j);
    double least = 1e9;
    for (std::size_t k = 0; k + 1 < g.slice_positions.size(); ++k) {
      least = std::min(least, glm::dot(g.slice_positions[k + 1] - g.slice_positions[k], normal));
    }
    return least;
  }
};

/// Voxels of a plane, known as far around the box as the band reaches.
struct Known {
  glm::ivec2 node;
  bool inside;
  float edge;
};

TEST(LabelPlanesLaws, EveryNodeHasItsDistanceToTheNearestVoxelOnEitherSide) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    OddMask odd(seed, seed % 2 == 1, seed % 4 >= 2);
    if (seed % 3 == 1) odd.mask.fractions = Mask::Fractions::occupancy;
    const OutlinePlanes planes = planes_of(odd.mask, 1.0 + seed % 3);
    const NodeLattice& lattice = planes.lattice;
    const Vec3 voxel(odd.mask.geometry.spacing_i, odd.mask.geometry.spacing_j, odd.least_step());
    EXPECT_NEAR(planes.play_mm, glm::length(voxel), 1e-9) << "a voxel's diagonal";
    const glm::ivec3 around = glm::ivec3(glm::ceil(planes.band_mm / voxel)) + 1;
    ASSERT_EQ(planes.node.size(), static_cast<std::size_t>(3 + 2 * around.z));
    const glm::ivec2 size(lattice.bricks * NodeBricks::edge);
    for (std::size_t plane = 0; plane < planes.node.size(); ++plane) {
      const int k = odd.mask.low.z - around.z + static_cast<int>(plane);
      EXPECT_NEAR(lattice.node_of(odd.center({0, 0, k})).z, planes.node[plane], 0.5001) << seed;
      std::vector<Known> known;
      for (int j = odd.mask.low.y - around.y; j < odd.mask.low.y + 3 + around.y; ++j) {
        for (int i = odd.mask.low.x - around.x; i < odd.mask.low.x + 4 + around.x; ++i) {
          const Vec3 node = lattice.node_of(odd.center({i, j, k}));
          const glm::ivec2 at(std::lround(node.x), std::lround(node.y));
          ASSERT_TRUE(at.x >= 0 && at.y >= 0 && at.x < size.x && at.y < size.y) << seed;
          known.push_back({at, odd.inside({i, j, k}), edge_distance({odd.mask, nullptr}, i, j, k)});
        }
      }
      PlaneDistances distances;
      planes.compute(plane, distances);
      ASSERT_EQ(distances.to_inside.size(), static_cast<std::size_t>(size.x * size.y));
      EXPECT_EQ(distances.known.empty(), odd.mask.fractions == Mask::Fractions::none);
      for (int trial = 0; trial < 120; ++trial) {
        // Half of them at voxels, since those are what has to be right.
        const Known& one = known[odd.random() % known.size()];
        const glm::ivec2 at = trial % 2 == 0 ? one.node
                                             : glm::ivec2(odd.random() % static_cast<unsigned>(size.x),
                                                          odd.random() % static_cast<unsigned>(size.y));
        double to_inside = 1e12, to_outside = 1e12;
        float edge = std::numeric_limits<float>::quiet_NaN();
        for (const Known& other : known) {
          const glm::dvec2 away = glm::dvec2(other.node - at) * glm::dvec2(lattice.spacing);
          double& nearest = other.inside ? to_inside : to_outside;
          nearest = std::min(nearest, glm::dot(away, away));
          if (other.node == at) edge = other.edge;
        }
        const auto index = static_cast<std::size_t>(at.y * size.x + at.x);
        const double band = planes.band_mm * planes.band_mm;
        for (const auto& [found, expected] :
             {std::pair{distances.to_inside[index], to_inside}, {distances.to_outside[index], to_outside}}) {
          if (expected < band) {
            ASSERT_NEAR(static_cast<double>(found), expected, 1e-4 * (1 + expected)) << seed;
          } else {
            ASSERT_GE(static_cast<double>(found), band * (1 - 1e-6)) << seed;
          }
        }
        if (!distances.known.empty()) {
          const float found = distances.known[index];
          ASSERT_TRUE(found == edge || (std::isnan(found) && std::isnan(edge))) << seed << ' ' << found << ' ' << edge;
        }
      }
    }
  }
}

// As many nodes from voxel to voxel along an axis as its spacing has of the finest, a power of two and 8 at most; twice
// as many within tilted slices and across uneven ones.
TEST(LabelPlanesLaws, NodesAreAsFineAsTheFinestAxis) {
  for (const auto& [spacing, parts] : {
           std::tuple{Vec3(1, 1, 1), glm::ivec3(1, 1, 1)},
           {Vec3(1, 1, 1.4), glm::ivec3(1, 1, 1)},
           {Vec3(1, 1, 1.6), glm::ivec3(1, 1, 2)},
           {Vec3(1, 1, 3), glm::ivec3(1, 1, 2)},
           {Vec3(1, 1, 4), glm::ivec3(1, 1, 4)},
           {Vec3(2, 0.5, 1), glm::ivec3(4, 1, 2)},
           {Vec3(0.5, 7, 0.5), glm::ivec3(1, 8, 1)},
           {Vec3(0.5, 0.5, 20), glm::ivec3(1, 1, 8)},
           {Vec3(9, 9, 1), glm::ivec3(8, 8, 1)},
       }) {
    for (const bool tilted : {false, true}) {
      for (const bool uneven : {false, true}) {
        Mask mask;
        Geometry& g = mask.geometry;
        g.dimensions = {6, 6, 5};
        g.spacing_i = spacing.x;
        g.spacing_j = spacing.y;
        const Vec3 step(tilted ? 0.3 * spacing.x : 0, 0, spacing.z);
        for (int k = 0; k < 5; ++k) g.slice_positions.push_back(static_cast<double>(k) * step);
        if (uneven) g.slice_positions[4].z += 0.4 * spacing.z;
        g.step = (g.slice_positions[4] - g.slice_positions[0]) / 4.0;
        mask.low = {2, 2, 2};
        mask.size = {1, 1, 1};
        mask.occupancy = {Mask::full};
        glm::ivec3 expected = parts;
        if (tilted) expected = glm::min(glm::ivec3(2 * parts.x, 2 * parts.y, parts.z), glm::ivec3(8));
        if (uneven) expected.z = std::min(2 * expected.z, 8);
        const OutlinePlanes planes = planes_of(mask, 1);
        const Vec3 found = spacing / planes.lattice.spacing;
        // Of 3 steps, 2 nodes; twice that is 6, of which 4 are.
        const auto is_power = [](double n) { return n == 1 || n == 2 || n == 4 || n == 8; };
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_NEAR(found[axis], expected[axis], 1e-9) << axis << ' ' << tilted << uneven << ' ' << spacing[axis];
          EXPECT_TRUE(is_power(std::round(found[axis])));
        }
        const int most = std::max({expected.x, expected.y, expected.z});
        EXPECT_EQ(1 << planes.coarser, most) << "the coarsest lattice has no node between the voxels";
      }
    }
  }
}

/// So that the coarser lattices hold them, too.
TEST(LabelPlanesLaws, AllPlanesLieWithinTheLatticeWithRoomAroundThem) {
  for (const double step : {1.0, 2.0, 4.0, 8.0}) {
    for (int tall = 1; tall <= 16; ++tall) {
      Mask mask;
      Geometry& g = mask.geometry;
      g.dimensions = {5, 5, 40};
      for (int k = 0; k < 40; ++k) g.slice_positions.emplace_back(0, 0, k * step);
      g.step = Vec3(0, 0, step);
      mask.low = {2, 2, 12};
      mask.size = {1, 1, tall};
      mask.occupancy.assign(static_cast<std::size_t>(tall), Mask::full);
      const OutlinePlanes planes = planes_of(mask, 1);
      const int room = 1 << planes.coarser;
      EXPECT_EQ(room, static_cast<int>(step));
      EXPECT_GE(planes.node.front(), room) << tall;
      EXPECT_LT(planes.node.back() + room, planes.lattice.bricks.z * NodeBricks::edge) << tall << ' ' << step;
    }
  }
}

// Slices that are off their places by less than a fiftieth of a voxel are taken as straight and even.
TEST(LabelPlanesLaws, AFiftiethOfAVoxelIsNotOff) {
  for (const auto& [off, parts] : {std::pair{0.019, 1.0}, {0.021, 2.0}}) {
    for (int axis = 0; axis < 3; ++axis) {
      Mask mask;
      Geometry& g = mask.geometry;
      g.dimensions = {6, 6, 5};
      for (int k = 0; k < 5; ++k) g.slice_positions.emplace_back(0, 0, k);
      // Along the planes the last one is beside the others; across them it is late, so that the least step stays.
      g.slice_positions[4][axis] += off;
      g.step = (g.slice_positions[4] - g.slice_positions[0]) / 4.0;
      mask.low = {2, 2, 2};
      mask.size = {1, 1, 1};
      mask.occupancy = {Mask::full};
      const Vec3 spacing = planes_of(mask, 1).lattice.spacing;
      EXPECT_NEAR(spacing.x, axis < 2 ? 1 / parts : 1, 1e-9) << axis << ' ' << off;
      EXPECT_NEAR(spacing.y, axis < 2 ? 1 / parts : 1, 1e-9) << axis << ' ' << off;
      EXPECT_NEAR(spacing.z, axis == 2 ? 1 / parts : 1, 1e-9) << axis << ' ' << off;
    }
  }
}

}  // namespace
}  // namespace palpate::io
