// Laws of what lies where, on scans of boxes whose regions can be said.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include "modes/scene/regions.h"

namespace palpate::modes::internal {
namespace regions_laws {

constexpr std::int16_t empty_hu = -1000, lung_hu = -800, soft_hu = 40;

/// Axial slices, all of room until boxes are put into them.
io::Volume room(const glm::ivec3& size, const io::Vec3& spacing) {
  io::Volume volume;
  volume.unit = "HU";
  io::Geometry& g = volume.geometry;
  g.dimensions = size;
  g.spacing_i = spacing.x;
  g.spacing_j = spacing.y;
  g.direction_i = {1, 0, 0};
  g.direction_j = {0, 1, 0};
  g.step = {0, 0, spacing.z};
  for (int k = 0; k < size.z; ++k) g.slice_positions.push_back(static_cast<double>(k) * g.step);
  volume.voxels = std::vector<std::int16_t>(volume.offset(0, 0, size.z), empty_hu);
  return volume;
}

template <class Use>
void for_voxels(const glm::ivec3& first, const glm::ivec3& end, const Use& use) {
  for (int k = first.z; k < end.z; ++k) {
    for (int j = first.y; j < end.y; ++j) {
      for (int i = first.x; i < end.x; ++i) use(glm::ivec3(i, j, k));
    }
  }
}

std::int16_t& stored(io::Volume& volume, const glm::ivec3& at) {
  return std::get<std::vector<std::int16_t>>(volume.voxels)[volume.offset(at.x, at.y, at.z)];
}

void put_box(io::Volume& volume, const glm::ivec3& first, const glm::ivec3& size, std::int16_t hu) {
  for_voxels(first, glm::min(first + size, volume.geometry.dimensions),
             [&](const glm::ivec3& at) { stored(volume, at) = hu; });
}

/// A body with a lung, and boxes of all kinds of values in them, beside them and at the scan's sides.
io::Volume boxes(std::mt19937_64& random, const glm::ivec3& size, const io::Vec3& spacing) {
  io::Volume volume = room(size, spacing);
  const auto any = [&](double least, double most) { return std::uniform_real_distribution(least, most)(random); };
  const auto box = [&](const glm::dvec3& first, const glm::dvec3& extent, std::int16_t hu) {
    put_box(volume, glm::ivec3(first * glm::dvec3(size)), glm::ivec3(extent * glm::dvec3(size)) + 1, hu);
  };
  const auto any_three = [&](double least, double most) {
    const double x = any(least, most), y = any(least, most), z = any(least, most);
    return glm::dvec3(x, y, z);
  };
  const glm::dvec3 first = any_three(0.05, 0.15), extent = any_three(0.6, 0.7);
  box(first, extent, soft_hu);
  box(first + 0.2 * extent, 0.5 * extent, lung_hu);
  const std::array<std::int16_t, 4> values{empty_hu, lung_hu, soft_hu, 700};
  for (std::size_t n = 0; n < 12; ++n) box(any_three(0, 0.95), any_three(0, 0.2), values[n % values.size()]);
  return volume;
}

/// Voxels of all shapes; whole cells of about 2.5 mm, so that those of the mirrored scan are the mirrored cells.
constexpr std::array<std::pair<io::Vec3, glm::ivec3>, 4> grids{{{{2.5, 2.5, 2.5}, {1, 1, 1}},
                                                                {{1.25, 0.8, 5}, {2, 3, 1}},
                                                                {{5, 1.2, 0.6}, {1, 2, 4}},
                                                                {{0.8, 2.5, 1.25}, {3, 1, 2}}}};

TEST(RegionsLaws, MirroredWithTheScan) {
  std::mt19937_64 random(31);
  std::array<int, 6> met{};
  for (int n = 0; n < 4; ++n) {
    const auto& [spacing, per_cell] = grids[static_cast<std::size_t>(n) % grids.size()];
    glm::ivec3 cells;
    for (int axis = 0; axis < 3; ++axis) cells[axis] = std::uniform_int_distribution(20, 30)(random);
    const io::Volume scan = boxes(random, cells * per_cell, spacing);
    const glm::ivec3 last = scan.geometry.dimensions - 1;
    const Regions regions(scan, 1);
    for (int axis = 0; axis < 3; ++axis) {
      const auto mirrored = [&](glm::ivec3 at) {
        at[axis] = last[axis] - at[axis];
        return at;
      };
      io::Volume other = scan;
      for_voxels(glm::ivec3(0), last + 1, [&](const glm::ivec3& at) {
        stored(other, at) = std::get<std::vector<std::int16_t>>(
            scan.voxels)[scan.offset(mirrored(at).x, mirrored(at).y, mirrored(at).z)];
      });
      const Regions theirs(other, 1);
      int different = 0;
      for_voxels(glm::ivec3(0), last + 1, [&](const glm::ivec3& at) {
        const Region region = regions.at(at);
        ++met[static_cast<std::size_t>(region)];
        different += theirs.at(mirrored(at)) != region ? 1 : 0;
      });
      EXPECT_EQ(different, 0) << n << ", axis " << axis;
    }
  }
  for (const Region region : {Region::room, Region::lung, Region::inner_air, Region::body, Region::table}) {
    EXPECT_GT(met[static_cast<std::size_t>(region)], 100) << static_cast<int>(region);
  }
}

TEST(RegionsLaws, SameWhereRowsAreCalledColumns) {
  std::mt19937_64 random(32);
  for (int n = 0; n < 4; ++n) {
    const auto& [spacing, per_cell] = grids[static_cast<std::size_t>(n) % grids.size()];
    glm::ivec3 size;
    for (int axis = 0; axis < 3; ++axis)
      size[axis] = std::uniform_int_distribution(20, 28)(random) * per_cell[axis] + 1;
    io::Volume scan = boxes(random, size, spacing);
    io::Volume other = room({size.y, size.x, size.z}, {spacing.y, spacing.x, spacing.z});
    for_voxels(glm::ivec3(0), size, [&](const glm::ivec3& at) {
      stored(other, {at.y, at.x, at.z}) = stored(scan, at);
    });
    const Regions regions(scan, 1), theirs(other, 1);
    int different = 0;
    for_voxels(glm::ivec3(0), size, [&](const glm::ivec3& at) {
      different += theirs.at({at.y, at.x, at.z}) != regions.at(at) ? 1 : 0;
    });
    EXPECT_EQ(different, 0) << n;
  }
}

/// Air and solid that no box is thick enough to mix: each cell is what its voxels are.
TEST(RegionsLaws, ABoxInTheRoomIsTheBodyToItsOwnEdge) {
  std::mt19937_64 random(33);
  for (int n = 0; n < 12; ++n) {
    const auto& [spacing, per_cell] = grids[static_cast<std::size_t>(n) % grids.size()];
    const auto cells = [&](int least, int most) { return std::uniform_int_distribution(least, most)(random); };
    const glm::ivec3 extent{cells(10, 14), cells(10, 14), cells(10, 14)}, first{cells(1, 4), cells(1, 4), cells(1, 4)};
    io::Volume scan = room(glm::ivec3(20, 21, 22) * per_cell, spacing);
    put_box(scan, first * per_cell, extent * per_cell, soft_hu);
    const Regions regions(scan, 1);
    int different = 0;
    for_voxels(glm::ivec3(0), scan.geometry.dimensions, [&](const glm::ivec3& at) {
      different += regions.at(at) != (stored(scan, at) == soft_hu ? Region::body : Region::room) ? 1 : 0;
    });
    EXPECT_EQ(different, 0) << n;
  }
}

/// A scan may end in padding on all sides: a round field of view, or one that was cropped or turned. The air that meets
/// it is the room's all the same, and what is in the room is what it is without padding.
TEST(RegionsLaws, TheRoomIsFoundWherePaddingIsAroundIt) {
  constexpr std::int16_t padding_hu = -2000;
  std::mt19937_64 random(37);
  for (int n = 0; n < 12; ++n) {
    const auto& grid = grids[static_cast<std::size_t>(n) % grids.size()];
    const auto& per_cell = grid.second;  // Clang 14 takes no structured binding into a lambda
    const auto cells = [&](int least, int most) { return std::uniform_int_distribution(least, most)(random); };
    const glm::ivec3 size{26, 27, 18}, extent{cells(10, 12), cells(10, 12), cells(10, 12)};
    const glm::ivec3 first{cells(7, 8), cells(7, 8), cells(1, 4)};
    const glm::ivec2 margin{cells(1, 3), cells(1, 3)};
    io::Volume scan = room(size * per_cell, grid.first);
    scan.padding = {padding_hu, padding_hu};
    put_box(scan, first * per_cell, extent * per_cell, soft_hu);
    put_box(scan, (first + 4) * per_cell, per_cell, empty_hu);  // air in the body
    const bool is_round = n / 4 == 1, is_bare = n / 4 == 2;
    const auto is_padded = [&](const glm::ivec3& cell) {
      if (is_bare) return false;
      if (is_round) return glm::length(glm::dvec2(cell.x - 12.5, cell.y - 13)) > 12;
      return cell.x < margin.x || cell.y < margin.y || cell.x >= size.x - margin.x || cell.y >= size.y - margin.y;
    };
    for_voxels(glm::ivec3(0), scan.geometry.dimensions, [&](const glm::ivec3& at) {
      if (is_padded(at / per_cell)) stored(scan, at) = padding_hu;
    });
    const Regions regions(scan, 1);
    std::array<int, 6> wrong{};
    for_voxels(glm::ivec3(0), scan.geometry.dimensions, [&](const glm::ivec3& at) {
      const glm::ivec3 cell = at / per_cell;
      const Region truth = is_padded(cell)                ? Region::none
                           : cell == first + 4            ? Region::inner_air
                           : stored(scan, at) == empty_hu ? Region::room
                                                          : Region::body;
      wrong[static_cast<std::size_t>(truth)] += regions.at(at) != truth ? 1 : 0;
    });
    EXPECT_EQ(wrong, (std::array<int, 6>{})) << n;
  }
}

/// Beside a body a plate is the table; where the plate is the larger of the two, which of them is the table is a guess.
TEST(RegionsLaws, NothingIsATableThatOutweighsTheBody) {
  std::mt19937_64 random(34);
  int tables = 0, guesses = 0;
  for (int n = 0; n < 20; ++n) {
    const auto cells = [&](int least, int most) { return std::uniform_int_distribution(least, most)(random); };
    io::Volume scan = room({40, 26, 40}, io::Vec3(2.5));
    const glm::ivec3 body{cells(9, 12), cells(9, 12), cells(9, 12)}, plate{cells(15, 38), 2, cells(15, 38)};
    put_box(scan, {2, 2, 2}, body, soft_hu);
    put_box(scan, {1, 20, 1}, plate, soft_hu);
    const int in_body = body.x * body.y * body.z, in_plate = plate.x * plate.y * plate.z;
    const Regions regions(scan, 1);
    const bool is_told = in_body > in_plate;
    ++(is_told ? tables : guesses);
    EXPECT_EQ(regions.at({5, 5, 5}), Region::body) << n;
    EXPECT_EQ(regions.at({5, 20, 5}), is_told ? Region::table : Region::body) << in_body << ", " << in_plate;
    EXPECT_NEAR(regions.milliliters(Region::table), is_told ? 2.5 * 2.5 * 2.5e-3 * in_plate : 0, 1e-9);
  }
  EXPECT_GT(std::min(tables, guesses), 3);
}

/// Of a channel in a long arm of the table that begins at the body: what is near to the body counts as its own.
TEST(RegionsLaws, AirIsOfTheTableWhereMoreOfItsWallIs) {
  std::mt19937_64 random(35);
  for (int n = 0; n < 12; ++n) {
    const auto cells = [&](int least, int most) { return std::uniform_int_distribution(least, most)(random); };
    io::Volume scan = room({90, 24, 24}, io::Vec3(2.5));
    put_box(scan, {2, 2, 2}, {20, 20, 20}, soft_hu);
    const glm::ivec3 from{22, cells(6, 16), cells(6, 16)};
    put_box(scan, from - glm::ivec3(0, 1, 1), {60, 3, 3}, soft_hu);
    const bool is_long = n % 2 == 0;
    const int length = is_long ? cells(18, 55) : cells(1, 4);
    put_box(scan, from, {length, 1, 1}, empty_hu);
    const Regions regions(scan, 1);
    EXPECT_EQ(regions.at(from + glm::ivec3(length - 1, 0, 0)), is_long ? Region::table : Region::inner_air) << length;
    EXPECT_EQ(regions.at({81, from.y, from.z}), Region::table);
  }
}

/// Along the gradient the first solid counts, and where there is none the farthest that is known; against it, the first
/// air.
TEST(RegionsLaws, SidesAreTheFirstAirAndTheFirstSolidOrTheFarthestOfAll) {
  std::mt19937_64 random(36);
  std::normal_distribution<double> along;
  std::array<int, 6> lows{}, highs{};
  for (int n = 0; n < 12; ++n) {
    const auto& [spacing, per_cell] = grids[static_cast<std::size_t>(n) % grids.size()];
    const io::Volume scan = boxes(random, glm::ivec3(26) * per_cell, spacing);
    const io::Geometry& g = scan.geometry;
    const Regions regions(scan, 1);
    for (int place = 0; place < 200; ++place) {
      glm::ivec3 voxel;
      glm::dvec3 gradient;
      for (int axis = 0; axis < 3; ++axis) {
        voxel[axis] = std::uniform_int_distribution(0, g.dimensions[axis] - 1)(random);
        gradient[axis] = 100 * along(random);
      }
      constexpr int steps = 30;  // of 0.5 mm
      const io::Vec3 at = g.to_patient(io::Vec3(voxel)), way = 0.5 * glm::normalize(gradient);
      Sides expected;
      for (int step = steps; step >= 0; --step) {
        const Region low = regions.at(g.to_index(at - static_cast<double>(step) * way));
        if (is_air(low)) expected.low = low;
      }
      for (int step = 0; step <= steps && expected.high != Region::body && expected.high != Region::table; ++step) {
        const Region high = regions.at(g.to_index(at + static_cast<double>(step) * way));
        if (high != Region::none) expected.high = high;
      }
      const Sides sides = regions.sides(g, voxel, gradient, 0.5 * steps + 0.1);
      EXPECT_EQ(sides.low, expected.low) << n << ", " << place;
      EXPECT_EQ(sides.high, expected.high) << n << ", " << place;
      ++lows[static_cast<std::size_t>(sides.low)];
      ++highs[static_cast<std::size_t>(sides.high)];
    }
    EXPECT_EQ(regions.sides(g, {1, 1, 1}, {0, 0, 0}, 9).low, Region::none) << "without a direction";
  }
  for (const Region region : {Region::room, Region::lung, Region::inner_air}) {
    EXPECT_GT(lows[static_cast<std::size_t>(region)], 10) << static_cast<int>(region);
  }
  EXPECT_GT(highs[static_cast<std::size_t>(Region::room)] + highs[static_cast<std::size_t>(Region::inner_air)], 10);
}

}  // namespace regions_laws
}  // namespace palpate::modes::internal
