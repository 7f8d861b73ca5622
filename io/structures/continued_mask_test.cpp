// Masks on lattices that are cropped to the structure, and masks of structures that run on where the scan ends.
#include "io/structures/continued_mask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

#include "io/structures/testing/one_mask.h"

namespace palpate::io {
namespace {

using Mm = std::function<double(const Vec3&)>;

using testing::OneMask;

/// `mm`: the depth in a body.
Mask mask_of(const Geometry& geometry, const Mm& mm, Mask::Fractions fractions) {
  Mask mask;
  mask.geometry = geometry;
  mask.size = geometry.dimensions;
  mask.fractions = fractions;
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        const double depth = mm(geometry.to_patient({i, j, k}));
        const double share =
            fractions == Mask::Fractions::none ? (depth > 0 ? 1 : 0) : std::clamp(0.5 + depth, 0.0, 1.0);
        mask.occupancy.push_back(static_cast<std::uint8_t>(std::lround(share * Mask::full)));
      }
    }
  }
  return mask;
}

/// Of the same voxels, a lattice that begins and ends with these.
Mask cropped(const Mask& mask, const glm::ivec3& low, const glm::ivec3& high) {
  Mask crop;
  crop.fractions = mask.fractions;
  crop.geometry = mask.geometry;
  crop.geometry.dimensions = crop.size = high - low + 1;
  crop.geometry.slice_positions.clear();
  for (int k = low.z; k <= high.z; ++k) {
    crop.geometry.slice_positions.push_back(mask.geometry.to_patient(Vec3(low.x, low.y, k)));
    for (int j = low.y; j <= high.y; ++j) {
      for (int i = low.x; i <= high.x; ++i) crop.occupancy.push_back(mask.occupancy[mask.offset(i, j, k)]);
    }
  }
  return crop;
}

/// The outermost voxels with some of it.
std::pair<glm::ivec3, glm::ivec3> box_of(const Mask& mask) {
  glm::ivec3 low = mask.size, high(-1);
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        if (mask.occupancy[mask.offset(i, j, k)] == 0) continue;
        low = glm::min(low, glm::ivec3(i, j, k));
        high = glm::max(high, glm::ivec3(i, j, k));
      }
    }
  }
  return {low, high};
}

Geometry lattice(const glm::ivec3& size, const Vec3& spacing, const glm::dmat3& axes, double tilt = 0) {
  Geometry g;
  g.dimensions = size;
  g.direction_i = axes[0];
  g.direction_j = axes[1];
  g.spacing_i = spacing.x;
  g.spacing_j = spacing.y;
  g.step = spacing.z * axes[2] + tilt * axes[1];
  const Vec3 first = axes * (-0.5 * Vec3(size - 1) * spacing) - 0.5 * (size.z - 1) * tilt * axes[1];
  for (int k = 0; k < size.z; ++k) g.slice_positions.push_back(first + static_cast<double>(k) * g.step);
  return g;
}

glm::dmat3 oblique_axes() {
  const Vec3 i = glm::normalize(Vec3(0.9, 0.3, -0.2)), j = glm::normalize(glm::cross(Vec3(0.2, -0.4, 1), i));
  return {i, j, glm::cross(i, j)};
}

struct Lattice {
  std::string name;
  Geometry geometry;
  std::vector<Mask::Fractions> fractions{Mask::Fractions::none};
};

std::vector<Lattice> lattices() {
  const glm::dmat3 straight(1);
  return {{"axial", lattice({30, 28, 26}, {1, 1, 1}, straight)},
          {"sagittal", lattice({30, 30, 18}, {1, 1, 1.6}, glm::dmat3(Vec3(0, 1, 0), Vec3(0, 0, -1), Vec3(-1, 0, 0)))},
          {"oblique",
           lattice({30, 28, 20}, {0.9, 1, 1.4}, oblique_axes()),
           {Mask::Fractions::none, Mask::Fractions::occupancy, Mask::Fractions::probability}}};
}

/// The largest difference near the surface of the first.
double most_apart(const DistanceField& one, const DistanceField& other, const Geometry& within) {
  double most = 0;
  for (int k = 0; k < within.dimensions.z; ++k) {
    for (int j = 0; j < within.dimensions.y; ++j) {
      for (int i = 0; i < within.dimensions.x; ++i) {
        const Vec3 at = within.to_patient({i, j, k});
        const double mm = one.sample(at).mm;
        if (std::abs(mm) < 2.5) most = std::max(most, std::abs(other.sample(at).mm - mm));
      }
    }
  }
  return most;
}

// Programs write a mask on a lattice that ends at the organ. The scan goes on there, and the organ does not.
TEST(CroppedMasks, HaveTheDistancesOfTheWholeLattice) {
  const Mm ball = [](const Vec3& at) { return 8.3 - glm::length(at - Vec3(0.3, -0.2, 0.4)); };
  for (const auto& [name, geometry, all_fractions] : lattices()) {
    // The nodes of a cropped lattice begin elsewhere: up to this part of a voxel.
    const double apart_mm = 0.15 * std::max({geometry.spacing_i, geometry.spacing_j, geometry.slice_spacing()});
    // Of the mask's own lattice, and one that lies across it and around it.
    const Geometry across = lattice({50, 50, 40}, {0.8, 0.8, 1}, oblique_axes(), 0.3);
    for (const Mask::Fractions fractions : all_fractions) {
      const Mask whole = mask_of(geometry, ball, fractions);
      const auto [low, high] = box_of(whole);
      for (const Geometry* scan : {&geometry, &across, static_cast<const Geometry*>(nullptr)}) {
        DistanceOptions options;
        options.scan = scan;
        const auto truth = OneMask(whole).distance(1, options);
        for (int face = scan == &geometry ? 0 : 6; face < 7; ++face) {  // the last: all of them
          SCOPED_TRACE(name + ", fractions " + std::to_string(static_cast<int>(fractions)) + ", face " +
                       std::to_string(face) +
                       (scan == nullptr   ? ", no scan"
                        : scan == &across ? ", across"
                                          : ""));
          glm::ivec3 first(0), last = geometry.dimensions - 1;
          for (int axis = 0; axis < 3; ++axis) {
            if (face == 2 * axis || face == 6) first[axis] = low[axis];
            if (face == 2 * axis + 1 || face == 6) last[axis] = high[axis];
          }
          const auto found = OneMask(cropped(whole, first, last)).distance(1, options);
          EXPECT_LT(most_apart(*truth, *found, geometry), apart_mm);
        }
      }
    }
  }
}

// Where the scan ends at the lattice's face, too, the organ runs on.
TEST(CroppedMasks, RunOnWhereTheScanEndsWithThem) {
  for (const auto& [name, geometry, all_fractions] : lattices()) {
    for (const Mask::Fractions fractions : all_fractions) {
      for (int face = 0; face < 6; ++face) {
        SCOPED_TRACE(name + ", fractions " + std::to_string(static_cast<int>(fractions)) + ", face " +
                     std::to_string(face));
        const int axis = face / 2;
        Vec3 index = 0.5 * Vec3(geometry.dimensions - 1), inward(0);
        index[axis] = face % 2 == 0 ? 0 : geometry.dimensions[axis] - 1;
        inward[axis] = face % 2 == 0 ? 1 : -1;
        const Vec3 end = geometry.to_patient(index);
        const Vec3 way = glm::normalize(geometry.to_patient(index + inward) - end);
        // A rod of 5 mm from beyond the face to 8 mm within.
        const Mm rod = [&](const Vec3& at) {
          const double along = glm::dot(at - end, way);
          return std::min(5 - glm::length(at - end - along * way), 8 - along);
        };
        const Mask whole = mask_of(geometry, rod, fractions);
        const auto [low, high] = box_of(whole);
        DistanceOptions options;
        options.scan = &geometry;
        for (const Mask& mask : {whole, cropped(whole, low, high)}) {
          const auto field = OneMask(mask).distance(1, options);
          for (const double along : {-0.4, 0.0, 1.0}) {
            EXPECT_GT(field->sample(end + along * way).mm, 3.5) << along;
          }
          Vec3 aside(0);
          aside[(axis + 1) % 3] = 1;
          const Vec3 beside = glm::normalize(geometry.to_patient(index + aside) - end);
          EXPECT_NEAR(field->sample(end + 4.0 * beside).mm, 1, 0.6);
          EXPECT_NEAR(field->sample(end + 6.5 * beside).mm, -1.5, 0.6);
        }
      }
    }
  }
}

// Without a scan nothing says that it runs on.
TEST(CroppedMasks, EndAtTheirLatticeWithoutAScan) {
  for (const auto& [name, geometry, all_fractions] : lattices()) {
    const auto field = OneMask(mask_of(
                                   geometry, [](const Vec3&) { return 1; }, Mask::Fractions::none))
                           .distance(1, {});
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool behind : {false, true}) {
        Vec3 index = 0.5 * Vec3(geometry.dimensions - 1);
        index[axis] = behind ? geometry.dimensions[axis] : -1;
        EXPECT_LT(field->sample(geometry.to_patient(index)).mm, 0) << name << axis << behind;
        index[axis] = behind ? geometry.dimensions[axis] - 1 : 0;
        EXPECT_GT(field->sample(geometry.to_patient(index)).mm, 0) << name << axis << behind;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io
