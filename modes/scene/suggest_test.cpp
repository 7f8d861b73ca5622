#include "modes/scene/suggest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "io/fields/volume_fields.h"
#include "modes/scene/hills.h"
#include "modes/scene/scene_json.h"
#include "modes/testing/test_rig.h"
#include "solver/text/testing/sanitized.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

using testdata::air_hu;
using testdata::bone_hu;
using testdata::soft_tissue_hu;

TEST(Hills, are_what_stands_out_of_its_valleys_and_holds_enough) {
  const std::array curve{0.F, 5.F, 9.F, 8.5F, 8.8F, 4.F, 1.F, 1.F, 1.F, 3.F, 6.F, 2.F, 0.F, 0.F, 0.1F, 0.F};
  const auto hills = internal::hills_of(curve, 0.15, 0.01);
  ASSERT_EQ(hills.size(), 2U);
  EXPECT_EQ(hills[0].top, 2U);
  EXPECT_EQ(hills[1].top, 10U);
  EXPECT_EQ(hills[0].end, hills[1].first);
  EXPECT_EQ(hills[1].end, curve.size()) << "the last bump holds too little to stand alone";
  EXPECT_EQ(internal::hills_of(curve, 0.01, 0.001).size(), 4U);
  EXPECT_EQ(internal::hills_of(std::array{9.F, 1.F, 8.F, 0.F}, 0.15, 0.01).size(), 2U) << "one is at the beginning";
  EXPECT_TRUE(internal::hills_of({}, 0.1, 0.1).empty());
  EXPECT_EQ(internal::hills_of(std::array{1.F, 1.F, 1.F}, 0.1, 0.1).size(), 1U);
}

struct Pair {
  double low, high;
};

struct Case {
  std::string name;
  testdata::Phantom phantom;
  std::vector<double> tissues;
  std::vector<Pair> boundaries;
};

std::vector<Case> cases() {
  const Vec3 inward = glm::normalize(Vec3(0.3, 1, 0.2));
  const std::vector<testdata::Layer> layers{{-10, soft_tissue_hu}, {6, bone_hu}};
  return {
      {"slab",
       testdata::make_slab(inward, layers),
       {air_hu, soft_tissue_hu, bone_hu},
       {{air_hu, soft_tissue_hu}, {soft_tissue_hu, bone_hu}}},
      {"sphere", testdata::make_sphere(20), {air_hu, soft_tissue_hu}, {{air_hu, soft_tissue_hu}}},
      {"shell", testdata::make_shell(12, 22), {air_hu, soft_tissue_hu}, {{air_hu, soft_tissue_hu}}},
      {"tube", testdata::make_tube(6, glm::normalize(Vec3(1, 2, 4))), {soft_tissue_hu, 300}, {{soft_tissue_hu, 300}}},
      {"wedge",
       testdata::make_wedge(70),
       {air_hu, soft_tissue_hu, bone_hu},
       {{air_hu, soft_tissue_hu}, {soft_tissue_hu, bone_hu}, {air_hu, bone_hu}}}};
}

std::shared_ptr<const io::Volume> scanned(const testdata::Phantom& phantom, const testdata::Grid& grid, double noise) {
  testdata::Acquisition acquisition;
  acquisition.noise = noise;
  return std::make_shared<const io::Volume>(testdata::scan(phantom, testdata::make_geometry(grid), acquisition));
}

/// Of the voxels at boundaries: the largest part that lies between two tissues which have no boundary in the phantom.
double share_of_others(const Suggestion& found, const Case& phantom) {
  const io::Bins& values = found.edges.values;
  const auto tissue_of = [&](double value) {
    std::size_t t = 0;
    while (t + 1 < found.scene.tissues.size() && value >= found.scene.tissues[t].high) ++t;
    return t;
  };
  std::map<std::pair<std::size_t, std::size_t>, double> counts;
  double all = 0;
  for (int high = 0; high < values.count; ++high) {
    for (int low = 0; low < high; ++low) {
      const auto count = static_cast<double>(found.edges.at(low, high));
      all += count;
      counts[{tissue_of(values.middle(low)), tissue_of(values.middle(high))}] += count;
    }
  }
  double largest = 0;
  for (const auto& [pair, count] : counts) {
    const auto is_true = [&, tissues = pair](const Pair& truth) {
      return std::abs(found.typical[tissues.first] - truth.low) < 20 &&
             std::abs(found.typical[tissues.second] - truth.high) < 20;
    };
    if (pair.first != pair.second && std::none_of(phantom.boundaries.begin(), phantom.boundaries.end(), is_true)) {
      largest = std::max(largest, count / all);
    }
  }
  return largest;
}

TEST(Suggest, finds_the_tissues_and_the_boundaries_of_every_phantom_and_no_other) {
  testdata::Grid oblique = rotated(testdata::Grid{}, {1, 2, 3}, 40);
  oblique.tilt_degrees = 15;
  for (const Case& phantom : cases()) {
    for (const double noise : {20.0, 0.0}) {
      for (const testdata::Grid& grid : {oblique, testdata::Grid{}}) {
        if (is_sanitized && !(noise > 0 && grid.tilt_degrees > 0)) {
          continue;  // the other three show no other memory
        }
        SCOPED_TRACE(::testing::Message() << phantom.name << ", noise " << noise << ", tilt " << grid.tilt_degrees);
        const Suggestion found = suggest(scanned(phantom.phantom, grid, noise));
        ASSERT_EQ(found.typical.size(), phantom.tissues.size());
        for (std::size_t t = 0; t < found.typical.size(); ++t) {
          EXPECT_NEAR(found.typical[t], phantom.tissues[t], 20);
          double nearest = infinity;
          for (const double other : phantom.tissues) {
            if (other != phantom.tissues[t]) nearest = std::min(nearest, std::abs(other - phantom.tissues[t]));
          }
          EXPECT_NEAR(found.scene.tissues[t].softness, 0.1 * nearest, 4) << "a tenth of the way to the nearest tissue";
        }
        EXPECT_EQ(found.boundaries.size(), phantom.boundaries.size());
        for (const Pair& pair : phantom.boundaries) {
          // Bone begins nearer to soft tissue than to dense bone.
          const double place = pair.low == soft_tissue_hu && pair.high > 200 ? 0.3 : 0.5;
          const auto is_it = [&](const FoundBoundary& boundary) {
            return std::abs(found.typical[boundary.low] - pair.low) < 20 &&
                   std::abs(found.typical[boundary.high] - pair.high) < 20 &&
                   std::abs(boundary.middle - (pair.low + place * (pair.high - pair.low))) <
                       0.1 * (pair.high - pair.low);
          };
          EXPECT_TRUE(std::any_of(found.boundaries.begin(), found.boundaries.end(), is_it)) << pair.low;
        }
        EXPECT_LE(share_of_others(found, phantom), 0.01);
        double shares = 0;
        for (std::size_t b = 0; b < found.boundaries.size(); ++b) {
          shares += found.boundaries[b].share;
          EXPECT_GT(found.boundaries[b].share, 0);
          EXPECT_LE(found.boundaries[b].share, found.boundaries[b == 0 ? 0 : b - 1].share);
        }
        EXPECT_NEAR(shares, 1, 0.02) << "the phantom has no other boundary";
      }
    }
  }
}

/// Only of HU is it known that bone begins nearer to soft tissue: in any other unit, and so on any scale, boundaries
/// are halfway.
TEST(Suggest, boundaries_of_a_scan_without_hu_are_halfway) {
  for (const double scale : {1.0, 3.0}) {
    io::Volume volume = *scanned(cases()[0].phantom, testdata::Grid{}, 20);
    volume.unit = "";
    volume.modality = "MR";
    volume.slope *= scale;
    volume.intercept *= scale;
    const Suggestion found = suggest(std::make_shared<const io::Volume>(std::move(volume)));
    ASSERT_EQ(found.boundaries.size(), 2U);
    for (const FoundBoundary& boundary : found.boundaries) {
      const double low = found.typical[boundary.low], high = found.typical[boundary.high];
      EXPECT_NEAR((boundary.middle - low) / (high - low), 0.5, 0.02) << scale;
    }
  }
}

TEST(Suggest, makes_a_scene_that_can_be_saved_and_read_and_names_tissues_by_their_hu) {
  const Suggestion found = suggest(scanned(cases()[0].phantom, testdata::Grid{}, 20));
  const Scene read = scene_from_json(to_json(found.scene), "suggested");
  EXPECT_EQ(to_json(read), to_json(found.scene));
  ASSERT_EQ(read.tissues.size(), 3U);
  EXPECT_EQ(read.tissues[0].name, "air");
  EXPECT_EQ(read.tissues[1].name, "soft tissue");
  EXPECT_EQ(read.tissues[2].name, "bone");
  std::vector<std::string> names;
  for (const Mode& mode : read.modes) {
    if (mode.type == "surface") names.push_back(mode.name);
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
  EXPECT_TRUE(std::binary_search(names.begin(), names.end(), "Bone"));
  EXPECT_TRUE(std::binary_search(names.begin(), names.end(), "Bone, from inside"));
  ASSERT_EQ(read.modes.size(), 5U);  // two boundaries, the way back of each, friction
  EXPECT_NE(read.modes[0].color, read.modes[1].color);
  for (const FoundBoundary& boundary : found.boundaries) {
    const Mode& up = read.modes[boundary.mode];
    const Mode& back = read.modes[boundary.way_back];
    EXPECT_TRUE(up.enabled);
    EXPECT_FALSE(back.enabled);
    EXPECT_EQ(back.from, up.to);
    EXPECT_EQ(back.to, up.from);
    EXPECT_EQ(back.color, up.color);
  }
  EXPECT_EQ(read.modes.back().type, "friction");
}

/// Feels a stroke through a slab of skin and bone with one boundary of the suggested scene alone.
std::vector<double> depths_of_contact(const Suggestion& found, const io::FieldSource& source, std::size_t mode,
                                      bool inwards) {
  Scene scene = found.scene;
  for (std::size_t m = 0; m < scene.modes.size(); ++m) {
    scene.modes[m].enabled = m == mode;
  }
  scene.subdivision.most = 8;
  const Vec3 inward = glm::normalize(Vec3(0.3, 1, 0.2));
  testing::Hand hand(scene, source);
  std::vector<double> depths;
  bool held = false;
  for (double depth = -25; depth < 25; depth += 0.02) {
    hand.move_to((inwards ? depth : -depth) * inward);
    const bool holds = hand.result.hold == HoldState::held && glm::length(hand.force()) > 0.2;
    if (holds && !held) {
      depths.push_back(glm::dot(hand.proxy_mm(), inward));
    }
    held = hand.result.hold == HoldState::held && (held || holds);
  }
  return depths;
}

TEST(Suggest, lets_each_boundary_be_felt_where_it_is_and_without_the_others) {
  const auto volume = scanned(cases()[0].phantom, testdata::Grid{}, 20);
  const Suggestion found = suggest(volume);
  ASSERT_EQ(found.boundaries.size(), 2U);
  const io::VolumeFields source(volume, io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::low_high,
                                io::default_gradient_scale_mm(volume->geometry));
  for (std::size_t b = 0; b < 2; ++b) {
    const std::vector<double> depths = depths_of_contact(found, source, found.boundaries[b].mode, true);
    ASSERT_FALSE(depths.empty()) << found.scene.modes[b].name;
    EXPECT_NEAR(depths[0], found.boundaries[b].middle < 0 ? -10 : 6, 0.5) << found.scene.modes[b].name;
    // It yields bit by bit as far as the gradient's scale reaches, and not at the other boundary, 16 mm away.
    EXPECT_LT(depths.back(), depths.front() + 6) << found.scene.modes[b].name;
    // From within, nothing resists but the way back; and that is met at the same place.
    EXPECT_TRUE(depths_of_contact(found, source, found.boundaries[b].mode, false).empty());
    EXPECT_TRUE(depths_of_contact(found, source, found.boundaries[b].way_back, true).empty());
    const std::vector<double> back = depths_of_contact(found, source, found.boundaries[b].way_back, false);
    ASSERT_FALSE(back.empty()) << found.scene.modes[b].name;
    EXPECT_NEAR(back[0], depths[0], 0.5) << found.scene.modes[b].name;
  }
}

/// The most that boundaries to bone could take near the top of a ball, N: whatever the proxy does there.
double bone_strength_near(const Suggestion& found, const io::FieldSource& source, const Vec3& center_mm,
                          double radius_mm) {
  const Plan plan = make_plan(found.scene, source.available(), {});
  double most = 0;
  for (const ActiveMode& active : plan.modes) {
    const bool is_to_bone = std::ranges::any_of(found.boundaries, [&](const FoundBoundary& b) {
      return b.mode == active.scene_index && found.typical[b.high] > 400;
    });
    if (!is_to_bone) continue;
    for (double up = radius_mm - 1.5; up < radius_mm + 1.5; up += 0.05) {
      most = std::max(most, active.strength(source.sample(center_mm + Vec3(0, 0, up), plan.fields)));
    }
  }
  return most;
}

/// A skull's worth of dense bone, and small pieces of fainter and of thin bone beside it: each is a boundary of nearly
/// the same strength.
TEST(Suggest, keeps_the_strength_of_thin_and_faint_bone) {
  testdata::Phantom phantom;
  phantom.background = air_hu;
  phantom.bodies = {{testdata::HalfSpace{{0, 0, 1}, 25}, soft_tissue_hu},
                    {testdata::HalfSpace{{0, 0, 1}, -16}, bone_hu}};
  struct Piece {
    Vec3 center_mm;
    double radius_mm, value, core_mm, least_part;  // cancellous within the core
  };
  std::vector<Piece> pieces;
  // Values spread evenly, as calcium is: none of them is a tissue of its own.
  for (double value = 300; value < 920; value += 40) {
    const auto [radius, core, least_part] = value > 800 ? std::array{5.0, 4.0, 0.75} : std::array{5.0, 0.0, 0.9};
    const auto n = static_cast<double>(pieces.size());
    const Vec3 center(-36 + 24 * std::fmod(n, 4), -36 + 24 * std::floor(n / 4), 5);
    pieces.push_back({center, radius, value, core, least_part});
    phantom.bodies.push_back({testdata::Ball{center, radius}, value});
    if (core > 0) phantom.bodies.push_back({testdata::Ball{center, core}, 200});
  }
  testdata::Grid grid;
  grid.size = {110, 110, 64};
  const auto volume = scanned(phantom, grid, 40);
  const Suggestion found = suggest(volume);
  const io::VolumeFields source(volume, io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::low_high,
                                io::default_gradient_scale_mm(volume->geometry));
  for (const Piece& piece : pieces) {
    const double newtons = bone_strength_near(found, source, piece.center_mm, piece.radius_mm);
    EXPECT_GT(newtons, piece.least_part * defaults::bone_strength_n) << piece.radius_mm << " mm, " << piece.value;
  }
}

TEST(Suggest, looks_for_tissues_a_tenth_of_the_range_beyond_its_ends) {
  const Suggestion found = suggest(scanned(cases()[0].phantom, testdata::Grid{}, 0));
  const double tenth = 0.1 * (bone_hu - air_hu);
  EXPECT_NEAR(found.edges.values.low, air_hu - tenth, 0.01 * tenth);
  EXPECT_NEAR(found.edges.values.high, bone_hu + tenth, 0.01 * tenth);
}

/// Eight boundaries between nine layers, and a faint wall within the last of them.
TEST(Suggest, finds_no_more_boundaries_than_there_are_colors) {
  testdata::Phantom phantom;
  phantom.background = 0;
  for (int layer = 1; layer < 9; ++layer) {
    phantom.bodies.push_back({testdata::HalfSpace{{0, 0, 1}, 32.0 - 5 * layer}, 100.0 * layer});
  }
  phantom.bodies.push_back({testdata::HalfSpace{{0, 0, 1}, -18}, 835});
  phantom.bodies.push_back({testdata::HalfSpace{{0, 0, 1}, -22}, 800});
  io::Volume volume = *scanned(phantom, testdata::Grid{}, 0);
  volume.unit = "";
  volume.modality = "MR";
  const Suggestion found = suggest(std::make_shared<const io::Volume>(std::move(volume)));
  ASSERT_EQ(found.boundaries.size(), 8U);
  std::set<std::string> colors;
  for (const FoundBoundary& boundary : found.boundaries) colors.insert(found.scene.modes[boundary.mode].color);
  EXPECT_EQ(colors.size(), 8U);
}

TEST(Suggest, gives_a_boundary_its_tissues_color) {
  const Suggestion found = suggest(scanned(testdata::make_chest(), {.size = {180, 190, 40}, .spacing = {2, 2, 2}}, 20));
  std::map<std::string, std::string> colors;
  for (const FoundBoundary& boundary : found.boundaries) {
    colors[found.scene.modes[boundary.mode].name] = found.scene.modes[boundary.mode].color;
  }
  EXPECT_EQ(colors, (std::map<std::string, std::string>{{"Skin, air inside the body and table", "#e69f00"},
                                                        {"Lung surface", "#56b4e9"},
                                                        {"Soft tissue", "#009e73"},
                                                        {"Bone", "#0072b2"}}));
}

TEST(Suggest, finds_nothing_where_there_is_nothing) {
  testdata::Phantom even;
  even.background = 40;
  EXPECT_TRUE(suggest(scanned(even, testdata::Grid{}, 0)).scene.modes.empty());
}

}  // namespace
}  // namespace palpate::modes
