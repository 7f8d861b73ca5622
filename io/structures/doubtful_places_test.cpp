// Outlines with known errors, on scans with analytic edges: every error is found, and nothing else.
#include "io/structures/doubtful_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "io/fields/filtered.h"
#include "io/structures/mask.h"
#include "io/structures/testing/one_mask.h"
#include "solver/text/testing/sanitized.h"
#include "testdata/scan.h"

namespace palpate::io {
namespace {

using SignedMm = std::function<double(const Vec3&)>;  // positive inside

/// An organ of some balls, 160 HU above what lies around it, with noise and a scanner's blur.
struct Organ {
  std::string name;
  std::vector<testdata::Ball> balls;

  double mm(const Vec3& at) const {
    double most = -1e9;
    for (const testdata::Ball& ball : balls) most = std::max(most, ball.radius - glm::distance(at, ball.center));
    return most;
  }
  std::shared_ptr<const Volume> scanned(const Geometry& geometry, unsigned seed) const {
    testdata::Phantom phantom{.background = -100, .bodies = {}};
    for (const testdata::Ball& ball : balls) phantom.bodies.push_back({ball, 60});
    const auto sharp = std::make_shared<const Volume>(testdata::scan(phantom, geometry, {.quantised = false}));
    Volume volume = *filtered(sharp, {.type = find_filter_type("gaussian"), .sigma_mm = 0.6});
    volume.filtered_from = nullptr;
    std::mt19937 random(seed);
    std::normal_distribution<float> noise(0, 12);
    for (float& value : std::get<std::vector<float>>(volume.voxels)) value += noise(random);
    return std::make_shared<const Volume>(std::move(volume));
  }
};

/// An error of an outline.
struct Spoilt {
  std::string what;
  SignedMm mm;
  double least_mm = 0;  ///< the edge is off by that at least somewhere; 0: nothing is spoilt
  DoubtKind kind = DoubtKind::edge;
  int side = 0;  ///< 1: the true edge lies outside; -1: inside; 0: on both sides
};

std::vector<Spoilt> spoilt_ways(const Organ& organ, std::mt19937& random) {
  std::normal_distribution<double> any;
  const auto truth = [organ](const Vec3& at) { return organ.mm(at); };
  const testdata::Ball& ball = organ.balls.front();
  const Vec3 way = glm::normalize(Vec3(-std::abs(any(random)), any(random), any(random)));  // away from a second ball
  const Vec3 top = ball.center + ball.radius * way;
  const auto without = [=](const SignedMm& gone) {
    return [=](const Vec3& at) { return std::min(truth(at), gone(at)); };
  };
  const auto with = [=](const SignedMm& more) { return [=](const Vec3& at) { return std::max(truth(at), more(at)); }; };
  const auto cap = [=](double height) {
    return without([=](const Vec3& at) { return glm::dot(top - at, way) - height; });
  };
  const auto tube = [=](const Vec3& at) {
    const double along = std::clamp(glm::dot(at - top, way), -3.0, 11.0);
    return 5.5 - glm::distance(at, top + along * way);
  };
  return {{.what = "nothing", .mm = truth},
          {.what = "roughness of half a voxel",
           .mm =
               [=](const Vec3& at) {
                 return truth(at) + 0.4 * std::sin(0.9 * at.x) * std::sin(1.1 * at.y) * std::sin(0.8 * at.z);
               }},
          {.what = "a low cap cut off", .mm = cap(5), .least_mm = 4, .side = 1},
          {.what = "a high cap cut off", .mm = cap(13), .least_mm = 9, .kind = DoubtKind::no_edge, .side = 1},
          {.what = "a dent",
           .mm = without([=](const Vec3& at) { return glm::distance(at, top + 2.0 * way) - 7; }),
           .least_mm = 4,
           .side = 1},
          {.what = "a bulge",
           .mm = with([=](const Vec3& at) { return 7 - glm::distance(at, top - 2.0 * way); }),
           .least_mm = 4,
           .side = -1},
          {.what = "a leak", .mm = with(tube), .least_mm = 9, .kind = DoubtKind::no_edge, .side = -1},
          {.what = "a shift", .mm = [=](const Vec3& at) { return truth(at - 3.0 * way); }, .least_mm = 2.5},
          {.what = "grown", .mm = [=](const Vec3& at) { return truth(at) + 2.5; }, .least_mm = 2.3, .side = -1},
          {.what = "an island",
           .mm = with([=](const Vec3& at) { return 4 - glm::distance(at, top + 9.0 * way); }),
           .least_mm = 4,
           .kind = DoubtKind::island,
           .side = -1},
          {.what = "a hole",
           .mm = without([=](const Vec3& at) { return glm::distance(at, ball.center + 4.0 * way) - 4; }),
           .least_mm = 4,
           .kind = DoubtKind::hole,
           .side = 1}};
}

std::shared_ptr<const DistanceField> outlined(const Geometry& geometry, const SignedMm& mm) {
  DistanceOptions options;
  options.reach_mm = doubt_within_mm;
  options.scan = &geometry;
  return distance_of(testing::mask_of(geometry, mm), options);
}

struct SpoiltGrid {
  std::string name;
  testdata::Grid grid;
};

std::vector<SpoiltGrid> spoilt_grids() {
  std::vector<SpoiltGrid> all{{"1 mm", {.size = glm::ivec3(76)}},
                              {"oblique", testdata::rotated({.size = {84, 80, 52}, .spacing = {0.9, 1, 1.5}},
                                                            glm::normalize(Vec3(1, 2, 0.5)), 23)}};
  all.resize(static_cast<std::size_t>(repeats(2, 1)));
  return all;
}

TEST(DoubtfulPlaces, WhatIsSpoiltIsListedAndNearlyNothingElse) {
  const std::vector<Organ> organs{{"ball", {{{0.3, -0.2, 0.4}, 19}}},
                                  {"two balls", {{{-6, 0, 1}, 18}, {{10, 3, -2}, 14}}}};
  std::mt19937 random(44);
  std::size_t entries = 0, of_nothing = 0;
  for (const SpoiltGrid& grid : spoilt_grids()) {
    const Organ& organ = organs[grid.name == "oblique" ? 1 : 0];
    const Geometry geometry = testdata::make_geometry(grid.grid);
    const double voxel = std::max({geometry.spacing_i, geometry.spacing_j, geometry.slice_spacing()});
    const auto volume = organ.scanned(geometry, static_cast<unsigned>(random()));
    const std::shared_ptr<const FieldSource> fields = edge_fields(volume);
    for (const Spoilt& spoilt : spoilt_ways(organ, random)) {
      SCOPED_TRACE(grid.name + ", " + organ.name + ", " + spoilt.what);
      const DoubtfulPlaces found = doubtful_places({*fields, geometry}, *outlined(geometry, spoilt.mm));
      EXPECT_GT(found.sampled, 500U);
      bool is_listed = false, is_of_its_kind = false;
      for (const DoubtfulPlace& place : found.places) {
        const double off = organ.mm(place.position_mm);  // positive: the outline lies inside of the true edge
        const bool is_off = std::abs(off) > 0.5 * voxel;
        ++entries;
        of_nothing += is_off ? 0 : 1;
        is_listed = is_listed || (is_off && (spoilt.side == 0 || (off > 0) == (spoilt.side > 0)));
        is_of_its_kind = is_of_its_kind || place.kind == spoilt.kind;
        EXPECT_NEAR(glm::length(place.normal), 1, 1e-9);
        if (place.kind == DoubtKind::edge) {
          EXPECT_NEAR(place.mean_mm, off, 2.5) << "the way to the true edge, with its sign";
          EXPECT_EQ(place.mean_mm > 0, place.largest_mm > 0);
        } else if (place.kind != DoubtKind::no_edge && is_off) {
          EXPECT_EQ(place.mean_mm > 0, off > 0) << "a hole's edge would go outwards, an island's inwards";
          EXPECT_EQ(place.largest_mm > 0, off > 0);
        }
      }
      EXPECT_EQ(is_listed, spoilt.least_mm > 0);
      EXPECT_TRUE(is_of_its_kind || spoilt.least_mm == 0);
      if (spoilt.what == "a shift") {
        const auto largest = std::ranges::max(found.places, {}, [](const auto& one) { return one.largest_mm; });
        EXPECT_NEAR(largest.largest_mm, 3, 0.8);
      }
    }
  }
  std::printf("%zu entries, %zu of nothing\n", entries, of_nothing);
  EXPECT_LE(10 * of_nothing, entries);
}

TEST(DoubtfulPlaces, TheLargestErrorComesFirstAndTheResultIsTheSameOnAnyNumberOfThreads) {
  const Geometry geometry = testdata::make_geometry({.size = glm::ivec3(76)});
  const Organ organ{"ball", {{{0, 0, 0}, 19}}};
  const std::shared_ptr<const FieldSource> fields = edge_fields(organ.scanned(geometry, 3));
  const auto field = outlined(geometry, [&](const Vec3& at) {
    return std::min({organ.mm(at), 14 - at.x, glm::distance(at, Vec3(0, 21, 0)) - 5});
  });
  const DoubtfulPlaces found = doubtful_places({*fields, geometry}, *field, {}, 1);
  ASSERT_GE(found.places.size(), 2U);
  EXPECT_GT(found.places[0].position_mm.x, 12);
  EXPECT_NEAR(found.places[0].largest_mm, 5, 0.8);
  EXPECT_GT(found.places[0].normal.x, 0.9);
  EXPECT_GT(found.places[1].position_mm.y, 12);
  const DoubtfulPlaces again = doubtful_places({*fields, geometry}, *field, {}, 3);
  ASSERT_EQ(again.places.size(), found.places.size());
  for (std::size_t n = 0; n < found.places.size(); ++n) {
    EXPECT_EQ(again.places[n].position_mm, found.places[n].position_mm);
    EXPECT_EQ(again.places[n].mean_mm, found.places[n].mean_mm);
  }
  EXPECT_EQ(again.without_edge, found.without_edge);
}

/// A ball of 60 HU in -100 HU. It has a dark core whose flat side lies across its middle.
std::shared_ptr<const Volume> scan_with_core(const Geometry& geometry, double radius) {
  const auto share = [](double mm) { return 0.5 * (1 + std::erf(mm / std::sqrt(2.0))); };
  Volume scan;
  scan.geometry = geometry;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 4);
  std::vector<float> voxels;
  const glm::ivec3 size = geometry.dimensions;
  for (int n = 0; n < size.x * size.y * size.z; ++n) {
    const Vec3 at = geometry.to_patient({n % size.x, n / size.x % size.y, n / (size.x * size.y)});
    const double depth = radius - glm::length(at), core = std::min({depth - 6, -at.x, at.x + 7});
    voxels.push_back(static_cast<float>(-100 + 160 * share(depth) - 120 * share(core) + noise(random)));
  }
  scan.voxels = std::move(voxels);
  return std::make_shared<const Volume>(std::move(scan));
}

// A cap is cut off 5 mm above the core. The core's edge is no end of the structure, so the scan has none there.
TEST(DoubtfulPlaces, AnEdgeInsideTheStructureIsNotItsEnd) {
  constexpr double radius = 15, cut_mm = 5;
  const Geometry geometry = testdata::make_geometry({.size = glm::ivec3(56)});
  const std::shared_ptr<const FieldSource> fields = edge_fields(scan_with_core(geometry, radius));
  const auto field =
      outlined(geometry, [=](const Vec3& at) { return std::min(radius - glm::length(at), cut_mm - at.x); });
  const ScanValues scan{*fields, geometry};
  const auto core = scan_edge(scan, *field, {cut_mm, 0, 0}, {1, 0, 0}, doubt_within_mm);
  ASSERT_TRUE(core) << "it is within reach";
  EXPECT_NEAR(core->mm, -cut_mm, 0.5);
  std::size_t without_edge = 0;
  for (const DoubtfulPlace& place : doubtful_places(scan, *field).places) {
    if (place.kind != DoubtKind::no_edge) {
      EXPECT_GT(place.mean_mm, 0) << "the ball's own edge lies outside";
      continue;
    }
    ++without_edge;
    EXPECT_NEAR(place.position_mm.x, cut_mm, 1);
    EXPECT_LT(glm::length(glm::dvec2(place.position_mm.y, place.position_mm.z)), 5);
    EXPECT_EQ(place.mean_mm, 0);
    EXPECT_EQ(place.largest_mm, 0);
    EXPECT_EQ(place.known_to_mm, 0);
  }
  EXPECT_EQ(without_edge, 1U);
}

}  // namespace
}  // namespace palpate::io
