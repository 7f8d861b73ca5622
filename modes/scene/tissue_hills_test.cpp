// Tissues and faint walls in counts of edges that are made by hand, so that what is found can be worked out by hand.
#include "modes/scene/tissue_hills.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "modes/scene/faint_walls.h"
#include "solver/text/testing/not_finite.h"

namespace palpate::modes::internal {
namespace {

class Edges {
 public:
  explicit Edges(const io::Bins& values)
      : edges{values, std::vector<std::uint64_t>(static_cast<std::size_t>(values.count) *
                                                 static_cast<std::size_t>(values.count))} {}
  Edges& add(int low_bin, int high_bin, std::uint64_t count) {
    edges.counts[static_cast<std::size_t>(high_bin) * static_cast<std::size_t>(edges.values.count) +
                 static_cast<std::size_t>(low_bin)] += count;
    return *this;
  }
  io::LowHighHistogram edges;
};

void expect_hill(const Hill& hill, std::size_t first, std::size_t top, std::size_t end) {
  EXPECT_EQ(hill.first, first);
  EXPECT_EQ(hill.top, top);
  EXPECT_EQ(hill.end, end);
}

constexpr double no_smoothing = 0.05;  // a kernel of one bin, where bins are 1 wide

TEST(TissueHills, part_in_the_middle_of_the_valley_which_is_all_that_is_no_higher_than_a_twentieth) {
  Edges counts({0, 100, 100});
  counts.add(20, 50, 100).add(50, 80, 200);
  // Beside the first hill: at a twentieth of it, and lower.
  counts.add(21, 50, 5);
  for (int bin = 22; bin <= 30; ++bin) counts.add(bin, 50, 4);
  // Beside the last: a shoulder above a twentieth, and one below.
  for (int bin = 77; bin <= 79; ++bin) counts.add(50, bin, 40);
  for (int bin = 70; bin <= 76; ++bin) counts.add(50, bin, 3);
  const TissueHills found = tissue_hills(counts.edges, {0, 100}, 6, no_smoothing, false);
  ASSERT_EQ(found.hills.size(), 3U);
  expect_hill(found.hills[0], 0, 20, 35);   // 21 to 49
  expect_hill(found.hills[1], 35, 50, 64);  // 51 to 76: 12.5 from 51, rounded up
  expect_hill(found.hills[2], 64, 80, 100);
  EXPECT_EQ(found.typical, (std::vector{20.5, 50.5, 80.5}));
}

TEST(TissueHills, are_of_edges_within_the_range_and_of_the_least_step_and_no_outermost_value) {
  Edges counts({0, 100, 100});
  counts.add(20, 50, 100).add(50, 80, 200).add(20, 90, 300);
  counts.add(60, 66, 1000);                   // 6 apart where more than 6 are asked for
  counts.add(0, 40, 1000).add(70, 99, 1000);  // beyond the ends, of no one value
  const TissueHills upper = tissue_hills(counts.edges, {40, 100}, 6, no_smoothing, false);
  ASSERT_EQ(upper.hills.size(), 2U);
  expect_hill(upper.hills[0], 40, 50, 65);
  expect_hill(upper.hills[1], 65, 80, 100);
  EXPECT_EQ(upper.typical, (std::vector{50.5, 80.5}));
  const TissueHills all = tissue_hills(counts.edges, {0, 100}, 5, no_smoothing, false);
  EXPECT_EQ(all.hills.size(), 6U) << "20, 50, 60, 66, 80 and 90";
}

TEST(TissueHills, of_a_ct_part_nearer_to_what_is_softer_than_bone) {
  Edges counts({-1000, 1000, 200});
  counts.add(10, 105, 100).add(105, 180, 100);  // -895, 55 and 805 HU
  const TissueHills ct = tissue_hills(counts.edges, {0, 200}, 6, no_smoothing, true);
  ASSERT_EQ(ct.hills.size(), 3U);
  EXPECT_EQ(ct.hills[0].end, 58U) << "of 11 to 104 the middle, 46.5 from 11";
  EXPECT_EQ(ct.hills[1].end, 128U) << "of 106 to 179 three tenths, 21.9 from 106";
  const TissueHills other = tissue_hills(counts.edges, {0, 200}, 6, no_smoothing, false);
  EXPECT_EQ(other.hills[0].end, 58U);
  EXPECT_EQ(other.hills[1].end, 143U) << "36.5 from 106";
}

/// Three tenths of the way where the softer hill's top is between -200 and 150 HU and the other's above 150; else half.
TEST(TissueHills, of_a_ct_part_at_the_place_that_their_tops_values_say) {
  std::mt19937_64 random(9);
  std::uniform_int_distribution<int> bin(3, 96), shift(1, 10);
  int near_to_soft = 0;
  for (int n = 0; n < 400; ++n) {
    // One of the two tops lies within a bin of one of the limits.
    const double limit = n % 2 == 0 ? -200 : least_bone_hu;
    const int at_limit = bin(random), other = bin(random);
    if (std::abs(at_limit - other) < 4) continue;
    const double low_end = limit - 20 * (at_limit + 0.1 * shift(random) - 0.05);
    Edges counts({low_end, low_end + 2000, 100});
    const int low = std::min(at_limit, other), high = std::max(at_limit, other);
    counts.add(low, high, 100);
    const TissueHills found = tissue_hills(counts.edges, {0, 100}, 2, 1, true);
    ASSERT_EQ(found.hills.size(), 2U);
    const auto top = [&](int of) { return low_end + 20 * (of + 0.5); };
    const bool is_soft = top(low) > -200 && top(low) < least_bone_hu && top(high) > least_bone_hu;
    near_to_soft += is_soft ? 1 : 0;
    // The valley is all bins between the two, and the one of the upper top counts as its end.
    const auto end = static_cast<int>(found.hills[0].end);
    EXPECT_NEAR(end - low - 1, (is_soft ? 0.3 : 0.5) * (high - low - 2), 0.5 + 1e-9) << low << ", " << high;
  }
  EXPECT_GT(near_to_soft, 50);
}

TEST(TissueHills, have_the_mean_of_what_lies_near_their_top) {
  Edges counts({0, 100, 100});
  counts.add(19, 70, 30).add(20, 70, 100).add(21, 70, 60);
  const TissueHills found = tissue_hills(counts.edges, {0, 100}, 6, 2, false);
  ASSERT_EQ(found.typical.size(), 2U);
  EXPECT_NEAR(found.typical[0], (30 * 19.5 + 100 * 20.5 + 60 * 21.5) / 190, 1e-9);
  EXPECT_NEAR(found.typical[1], 70.5, 1e-9);
}

/// Three tissues of 300, 400 and 300 bins of 1, with two sides each, 30 apart around its middle.
struct Three {
  TissueHills tissues{{{0, 100, 300}, {300, 500, 700}, {700, 900, 1000}}, {100.5, 500.5, 900.5}};
  std::vector<Noise> noise{{0, 0.1}, {0, 0.2}, {0, 0.3}};
  Edges counts{{0, 1000, 1000}};

  std::vector<FaintWall> walls(double voxels_at_boundaries, bool is_ct) const {
    return faint_walls(counts.edges, tissues, noise, 1000, voxels_at_boundaries, is_ct);
  }
};

TEST(FaintWalls, are_looked_for_within_every_tissue_but_the_darkest_and_in_a_ct_between_air_and_bone) {
  Three three;
  three.counts.add(85, 115, 100).add(485, 515, 120).add(885, 915, 110);
  const std::vector<FaintWall> walls = three.walls(1000, false);
  ASSERT_EQ(walls.size(), 2U);
  EXPECT_EQ(walls[0].within, 1U) << "the most frequent first";
  EXPECT_EQ(walls[1].within, 2U);
  EXPECT_NEAR(walls[0].low, 485.5, 1e-9);
  EXPECT_NEAR(walls[0].high, 515.5, 1e-9);
  EXPECT_NEAR(walls[0].share, 0.12, 1e-12);
  EXPECT_EQ(walls[0].noise_gradient, 0.2);
  EXPECT_EQ(walls[0].low_side.low, 300);
  EXPECT_NEAR(walls[0].low_side.high, 500.5, 1.5);
  EXPECT_EQ(walls[0].high_side.low, walls[0].low_side.high);
  EXPECT_EQ(walls[0].high_side.high, 700);
  EXPECT_NEAR(walls[0].low_side.softness, 3, 1e-9);
  EXPECT_NEAR(walls[0].high_side.softness, 3, 1e-9);
  EXPECT_EQ(walls[1].low_side.low, 700);
  EXPECT_EQ(walls[1].high_side.high, infinity);
  const std::vector<FaintWall> in_ct = three.walls(1000, true);
  ASSERT_EQ(in_ct.size(), 1U) << "above 150 HU all is bone";
  EXPECT_EQ(in_ct[0].within, 0U);
  EXPECT_EQ(in_ct[0].low_side.low, -infinity);
  EXPECT_EQ(in_ct[0].high_side.high, 300);
  three.tissues.typical[0] = -950;
  EXPECT_TRUE(three.walls(1000, true).empty()) << "in air";
}

TEST(FaintWalls, are_of_a_25th_of_the_voxels_at_boundaries_or_more) {
  Three three;
  three.counts.add(485, 515, 40);
  EXPECT_EQ(three.walls(1000, false).size(), 1U);
  EXPECT_TRUE(three.walls(1001, false).empty());
}

TEST(FaintWalls, differ_by_more_than_noise_does_and_by_more_than_can_be_told_apart) {
  for (const auto& [step, noise, is_wall] :
       {std::tuple{19, 0.0, true}, {16, 0.0, false}, {30, 7.0, true}, {30, 8.0, false}, {50, 12.0, true}}) {
    Three three;
    three.noise[1].value = noise;
    three.counts.add(500 - step / 2, 500 - step / 2 + step, 100);
    EXPECT_EQ(three.walls(1000, false).size(), is_wall ? 1U : 0U) << step << ", noise " << noise;
  }
}

TEST(FaintWalls, are_farther_from_the_next_tissue_than_half_their_step) {
  for (const auto& [low, is_wall] : {std::pair{312, false}, {317, true}, {652, true}, {657, false}}) {
    Three three;
    three.counts.add(low, low + 30, 100);
    EXPECT_EQ(three.walls(1000, false).size(), is_wall ? 1U : 0U) << low;
  }
  // What has no next tissue has no such limit.
  Three three;
  three.counts.add(960, 990, 100);
  EXPECT_EQ(three.walls(1000, false).size(), 1U);
}

}  // namespace
}  // namespace palpate::modes::internal
