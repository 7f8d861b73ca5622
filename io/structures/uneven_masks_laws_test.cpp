// Masks on slices that are not evenly apart: bounds of bodies given by a formula, edges by fractions, and what goes on
// beyond the scan. The truth is the formula.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "io/errors.h"
#include "io/structures/distance_bounds.h"
#include "io/structures/fraction_edges.h"
#include "io/structures/label_planes.h"
#include "io/structures/testing/one_mask.h"

namespace palpate::io {
namespace {

using testing::mask_of;
using testing::OneMask;

/// Slices at these heights around the z axis.
Geometry slices_at(int columns, double spacing, const std::vector<double>& heights) {
  Geometry g;
  g.dimensions = {columns, columns, static_cast<int>(heights.size())};
  g.spacing_i = g.spacing_j = spacing;
  const double corner = -0.5 * (columns - 1) * spacing;
  for (const double height : heights) g.slice_positions.emplace_back(corner, corner, height);
  g.step = (g.slice_positions.back() - g.slice_positions.front()) / (g.dimensions.z - 1.0);
  g.uniform = false;
  return g;
}

std::vector<double> heights_of(const std::vector<std::pair<int, double>>& runs) {
  std::vector<double> heights{0};
  for (const auto& [count, step] : runs) {
    for (int n = 0; n < count; ++n) heights.push_back(heights.back() + step);
  }
  return heights;
}

// Bounds are bounds: a body with these voxels is never nearer or farther. A plane is such a body.
TEST(UnevenMasksLaws, BoundsHoldForEveryPlane) {
  std::mt19937 random(5);
  const auto any = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  int checked = 0;
  for (const auto& heights : {heights_of({{8, 1}, {4, 5}}), heights_of({{4, 3}, {12, 1}}), heights_of({{9, 2}}),
                              heights_of({{5, 1}, {1, 4}, {6, 1}}), heights_of({{4, 6}, {6, 0.75}})}) {
    const Geometry geometry = slices_at(28, 0.75, heights);
    for (int trial = 0; trial < 3; ++trial) {
      const Vec3 normal = glm::normalize(trial == 0 ? Vec3(1, 0, -1) : Vec3(any(-1, 1), any(-1, 1), any(-1, 1)));
      const Vec3 through(any(-1, 1), any(-1, 1), any(0.35, 0.65) * heights.back());
      const auto depth = [&](const Vec3& at) { return glm::dot(at - through, normal); };
      const DistanceBounds bounds = bounds_of(planes_of(mask_of(geometry, depth), 1), 2);
      const NodeLattice& lattice = bounds.bricks.lattice;
      for (std::size_t brick = 0; brick < bounds.bricks.count(); ++brick) {
        for (int n = 0; n < 512; ++n) {
          const glm::ivec3 node = bounds.bricks.place[brick] * 8 + glm::ivec3(n % 8, n / 8 % 8, n / 64);
          const Vec3 at = lattice.position(node);
          const bool is_amid =
              std::abs(at.x) < 4 && std::abs(at.y) < 4 && at.z > 0.3 * heights.back() && at.z < 0.7 * heights.back();
          if (!is_amid || std::abs(depth(at)) > 4) continue;
          const std::size_t place = brick * 512 + static_cast<std::size_t>(n);
          ASSERT_LE(static_cast<double>(bounds.lower[place]), depth(at) + 0.01) << trial << ' ' << heights[1];
          ASSERT_GE(static_cast<double>(bounds.upper[place]), depth(at) - 0.01) << trial << ' ' << heights[1];
          ++checked;
        }
      }
    }
  }
  EXPECT_GT(checked, 5000);
}

// A face along the slices that leaves a share of its slab inside: half of the way to the slices beside it, both ways.
TEST(UnevenMasksLaws, AShareOfASlabIsAPartOfItsOwnThickness) {
  const std::vector<std::vector<double>> stacks{heights_of({{6, 5}, {20, 1}}), heights_of({{20, 1}, {6, 5}}),
                                                heights_of({{4, 2}, {1, 6}, {4, 2}}), heights_of({{8, 1.5}})};
  for (const std::vector<double>& heights : stacks) {
    const int last = static_cast<int>(heights.size()) - 1;
    for (int k = 1; k < last; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const double below = heights[at] - heights[at - 1], above = heights[at + 1] - heights[at];
      for (const double share : {0.1, 0.3, 0.5, 0.75, 0.9}) {
        for (const bool is_below : {true, false}) {  // what is inside
          Mask mask;
          mask.geometry = slices_at(5, 0.8, heights);
          mask.size = mask.geometry.dimensions;
          for (int slice = 0; slice <= last; ++slice) {
            const double part = slice == k ? share : ((slice < k) == is_below ? 1 : 0);
            mask.occupancy.insert(mask.occupancy.end(), 25, static_cast<std::uint8_t>(std::lround(part * Mask::full)));
          }
          const double rounding = 0.01 * (below + above);
          mask.fractions = Mask::Fractions::occupancy;
          const auto by_share = static_cast<double>(edge_distance({mask, nullptr}, 2, 2, k));
          EXPECT_NEAR(by_share, (share - 0.5) * (below + above) / 2, rounding) << k << ' ' << share;
          // Of probabilities it is where half lies on the line to the slice on the other side. Half is inside.
          mask.fractions = Mask::Fractions::probability;
          const double part = std::round(share * Mask::full) / Mask::full;
          const bool is_to_upper = (part >= 0.5) == is_below;
          const double slope = (part >= 0.5 ? part : 1 - part) / (is_to_upper ? above : below);
          const auto by_half = static_cast<double>(edge_distance({mask, nullptr}, 2, 2, k));
          EXPECT_NEAR(by_half, (part - 0.5) / slope, 1e-4) << k << ' ' << share << is_below;
        }
      }
    }
  }
}

// Where the scan ends the structure goes on as it ends, also half a slice beyond, however far apart the last slices
// are.
TEST(UnevenMasksLaws, AStructureGoesOnBeyondTheScansLastSlices) {
  for (const auto& heights : {heights_of({{10, 1}, {2, 5}}), heights_of({{2, 4}, {4, 2}, {2, 4}})}) {
    const Geometry scan = slices_at(16, 1, heights);
    for (const bool is_up : {false, true}) {
      const double end = is_up ? heights.back() : heights.front();
      const double step = is_up ? end - heights[heights.size() - 2] : heights[1] - end;
      const double way = is_up ? 1 : -1;
      const auto rod = [&](const Vec3& at) { return std::min(4.2 - std::hypot(at.x, at.y), 13 + way * (at.z - end)); };
      DistanceOptions options;
      options.scan = &scan;
      const auto field = OneMask(mask_of(scan, rod)).distance(1, options);
      for (const double beyond : {0.0, 0.2, 0.49}) {
        const double z = end + way * beyond * step;
        EXPECT_GT(field->sample({0, 0, z}).mm, 2.9) << heights[1] << is_up << ' ' << beyond;
        EXPECT_NEAR(field->sample({3.2, 0, z}).mm, 1, 0.5) << heights[1] << is_up << ' ' << beyond;
        EXPECT_NEAR(field->sample({0, 5.2, z}).mm, -1, 0.5) << heights[1] << is_up << ' ' << beyond;
      }
    }
  }
}

// Where all steps are whole multiples of the least, every slice lies on the coarser lattices, also beyond the ends.
TEST(UnevenMasksLaws, SlicesLieOnTheCoarserLattices) {
  for (const auto& heights : {heights_of({{9, 2}, {4, 6}}), heights_of({{3, 8}, {9, 4}}), heights_of({{4, 2}, {3, 10}}),
                              heights_of({{1, 12}, {7, 4}}), heights_of({{6, 4}})}) {
    const Geometry geometry = slices_at(20, 0.5, heights);
    const auto ball = [&](const Vec3& at) { return 3 - glm::length(at - geometry.slice_positions[2] * Vec3(0, 0, 1)); };
    for (const bool is_whole : {true, false}) {
      Mask mask = mask_of(geometry, ball);
      if (!is_whole) {  // the box of its one end
        mask.size.z = 2;
        mask.low.z = geometry.dimensions.z - 2;
        mask.occupancy.assign(static_cast<std::size_t>(mask.size.x * mask.size.y * mask.size.z), Mask::full);
      }
      const OutlinePlanes planes = planes_of(mask, 3);
      ASSERT_GT(planes.coarser, 0);
      for (const int node : planes.node) EXPECT_EQ(node % (1 << planes.coarser), 0) << heights[1] << is_whole;
    }
  }
}

// A gap over which nothing is known, or one frame that a damaged file puts far away: the lattice grows by neither.
TEST(UnevenMasksLaws, AGapMakesNoLargerLattice) {
  const auto lattice_of = [](const std::vector<double>& heights) {
    Mask mask;
    mask.geometry = slices_at(12, 0.5, heights);
    mask.size = mask.geometry.dimensions;
    mask.occupancy.assign(static_cast<std::size_t>(144 * mask.size.z), Mask::full);
    return planes_of(mask, 3);
  };
  for (const double step : {1.0, 2.5}) {
    const int even = lattice_of(heights_of({{9, step}})).lattice.bricks.x;
    for (const int gap : {30, 200, 19999}) {
      for (const int at : {1, 4, 8}) {
        const auto planes = lattice_of(heights_of({{at, step}, {1, gap * step}, {9 - at, step}}));
        EXPECT_LE(planes.play_mm, 17 * step) << gap << ' ' << at;
        EXPECT_LE(planes.lattice.bricks.x, even + 2 * std::ceil(17 * step / 0.5 / 8) + 2) << gap << ' ' << at;
      }
    }
  }
  // Where the least step is as wide, no lattice holds it.
  for (const int step : {20000, 50000}) {
    try {
      lattice_of(heights_of({{4, step}}));
      ADD_FAILURE() << step;
    } catch (const DicomError& error) {
      EXPECT_EQ(std::string(error.what()), "its slices and the steps between them span " + std::to_string(4 * step) +
                                               " mm: more than can be felt");
    }
  }
}

/// A square of 10 x 10 voxels on one slice of a scan, whose file does not say how thick it is.
Mask square_on_slice(const Geometry& scan, std::size_t k) {
  Mask mask;
  mask.geometry = scan;
  mask.geometry.slice_positions = {scan.slice_positions[k]};
  mask.geometry.dimensions.z = mask.size.z = 1;
  mask.geometry.step = {0, 0, 1};
  mask.has_no_thickness = true;
  mask.low = {2, 2, 0};
  mask.size.x = mask.size.y = 10;
  mask.occupancy.assign(100, Mask::full);
  return mask;
}

// One slice whose file does not say how thick it is reaches half of the way to the scan's slices beside it, however far
// the others lie. With a thickness that it says it keeps that.
TEST(UnevenMasksLaws, OneSliceIsAsThickAsTheScanThere) {
  for (const auto& heights :
       {heights_of({{9, 3}, {1, 183}, {10, 3}}), heights_of({{20, 1}, {10, 5}}), heights_of({{10, 5}, {20, 1}}),
        heights_of({{9, 3}, {1, 18}}), heights_of({{3, 2.5}}), heights_of({{4, 2.9}, {1, 3.3}, {5, 3.1}})}) {
    const Geometry scan = slices_at(14, 1, heights);
    for (std::size_t k = 0; k < heights.size(); ++k) {
      Mask mask = square_on_slice(scan, k);
      const double below = heights[std::max<std::size_t>(k, 1)] - heights[std::max<std::size_t>(k, 1) - 1];
      const std::size_t next = std::min(k + 1, heights.size() - 1);
      const double above = heights[next] - heights[next - 1];
      constexpr double beyond = 20;  // mm: slices farther away are not asked
      const double step = below > beyond ? above : above > beyond ? below : (below + above) / 2;
      EXPECT_NEAR(OneMask(mask).measure(1, {}, &scan).volume_mm3, 100 * step, 1e-6) << heights.size() << ' ' << k;
      mask.has_no_thickness = false;
      mask.geometry.step = {0, 0, 30};
      EXPECT_NEAR(OneMask(mask).measure(1, {}, &scan).volume_mm3, 3000, 1e-6) << heights.size() << ' ' << k;
    }
  }
}

// Two slices that nearly lie on each other: the lattice is no finer for them than for a tenth of a step.
TEST(UnevenMasksLaws, SlicesThatNearlyLieOnEachOtherAskForNoFinerLattice) {
  for (const double apart : {0.1, 0.012, 1e-4, 1e-7}) {
    for (const int at : {0, 4, 9}) {  // which of them is there twice
      std::vector<double> heights = heights_of({{9, 2}});
      heights.insert(heights.begin() + at + 1, heights[static_cast<std::size_t>(at)] + apart);
      const Geometry geometry = slices_at(16, 0.5, heights);
      const auto ball = [](const Vec3& place) { return 3.4 - glm::length(place - Vec3(0, 0, 9)); };
      const Mask mask = mask_of(geometry, ball);
      const OutlinePlanes planes = planes_of(mask, 3);
      EXPECT_LE(planes.node.size(), 11U + 2 * 50U) << apart << ' ' << at;
      EXPECT_GE(planes.lattice.spacing.z, 0.1 * 2 / 8 - 1e-9) << apart << ' ' << at;
    }
  }
}

// A few slices of a scan whose steps vary a little: the body ends between them and the scan's next slices, which are
// empty, and well away from its own.
TEST(UnevenMasksLaws, ABodyEndsBetweenItsSlicesAndTheScansNextOnes) {
  for (const double off : {0.025, 0.1}) {
    for (const double step : {5.0}) {
      std::vector<double> heights = heights_of({{5, step}});
      for (std::size_t k = 2; k < heights.size(); k += 3) heights[k] += off * step;
      const Geometry scan = slices_at(14, 1, heights);
      for (const int count : {1, 2}) {
        for (const double said_mm : {1.0}) {  // of one slice: less than the scan says
          const int first = 2;
          Mask mask;
          mask.geometry = scan;
          const auto from = scan.slice_positions.begin() + first;
          mask.geometry.slice_positions.assign(from, from + count);
          mask.geometry.dimensions.z = mask.size.z = count;
          mask.geometry.step = count == 1 ? Vec3(0, 0, said_mm) : mask.geometry.slice_positions[1] - *from;
          mask.has_no_thickness = count == 1;
          mask.low = {2, 2, 0};
          mask.size.x = mask.size.y = 10;
          mask.occupancy.assign(static_cast<std::size_t>(100 * count), Mask::full);
          DistanceOptions options;
          options.scan = &scan;
          const auto field = OneMask(mask).distance(1, options);
          const double low = heights[first], high = heights[static_cast<std::size_t>(first + count - 1)];
          for (const double side : {-1.0, 1.0}) {
            const double end = side < 0 ? low : high;
            EXPECT_GT(field->sample({0, 0, end + 0.3 * side * step}).mm, 0) << off << ' ' << step << ' ' << count;
            EXPECT_LT(field->sample({0, 0, end + 1.12 * side * step}).mm, 0) << off << ' ' << step << ' ' << count;
          }
        }
      }
    }
  }
}

// The same of one slice of unsaid thickness where the scan's steps are no multiples of one: it is felt as in a scan
// that has the steps beside it everywhere.
TEST(UnevenMasksLaws, OneSliceOfUnevenStepsIsFeltAsAmongEvenOnes) {
  const std::vector<double> uneven = heights_of({{5, 2}, {5, 5.3}});
  const auto felt = [](const std::vector<double>& heights, std::size_t k) {
    const Geometry scan = slices_at(14, 1, heights);
    const Mask mask = square_on_slice(scan, k);
    DistanceOptions options;
    options.scan = &scan;
    const auto field = OneMask(mask).distance(1, options);
    std::vector<double> mm;
    for (double z = -5; z <= 5; z += 0.5) mm.push_back(field->sample({0, 0, heights[k] + z}).mm);
    return mm;
  };
  for (const std::size_t k : {2U, 8U}) {
    const std::vector<double> here = felt(uneven, k), wanted = felt(heights_of({{10, uneven[k + 1] - uneven[k]}}), k);
    for (std::size_t n = 0; n < here.size(); ++n) EXPECT_NEAR(here[n], wanted[n], 0.05) << k << ' ' << n;
  }
}

}  // namespace
}  // namespace palpate::io
