// The edits that are refused, in words; and those that need the scan or have no structure yet.
#include "io/structures/edits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "io/structures/outline_places.h"
#include "io/testing/made_labels.h"
#include "solver/text/message.h"
#include "solver/text/testing/shown.h"

namespace palpate::io {
namespace {

std::shared_ptr<const DistanceField> ball_to_edit(double radius = 9, const Vec3& center = Vec3(0)) {
  return distance_of(made_labels([=](const Vec3& at) { return glm::distance(at, center) < radius; }, radius + 8));
}

std::string refusal(const Edit& edit, const std::shared_ptr<const DistanceField>& field) {
  return palpate::testing::said_when([&] { apply_edit(field, edit); });
}

TEST(Edits, WhatCannotBeDoneIsRefusedInWords) {
  const auto ball = ball_to_edit();
  EXPECT_EQ(
      refusal(TraceEdit{.points_mm = {Vec3(9, 0, 0), Vec3(0, 0, 19)}, .known_to_mm = {}}, ball),
      "trace: its point 2 lies 9.9 mm from the edge and its reach is 8 mm: give it a larger reach, or add what is "
      "missing (\"add\")");
  EXPECT_EQ(
      refusal(TraceEdit{.points_mm = {Vec3(16, 0, 0)}, .known_to_mm = {}}, ball),
      "trace: its point 1 lies 6.9 mm from the edge, and the edge there would be an island: give it a reach of 16 "
      "mm or more, or add what is missing (\"add\")");
  EXPECT_EQ(refusal(AddEdit{{.path_mm = {Vec3(0), Vec3(900, 0, 0)}}}, ball), "add: its point 2 lies off the scan");
  EXPECT_EQ(refusal(RemoveEdit{{.path_mm = {Vec3(0)}, .radius_mm = 14}}, ball),
            "remove: it leaves nothing of the structure");
  EXPECT_EQ(refusal(AddEdit{}, ball), "add: it has no points");
  EXPECT_EQ(refusal(AddEdit{{.path_mm = {Vec3(0)}}}, nullptr),
            "add: there is no structure yet to be changed: the first edit has to be \"contours\"");
  EXPECT_EQ(refusal(ContoursEdit{{{Vec3(0), Vec3(9, 0, 0), Vec3(0, 9, 0)}}}, ball),
            "contours: contours make a new structure: they have to be the first edit of a structure without a file");
  EXPECT_EQ(refusal(ScanEdgeEdit{}, ball), "scan_edge: the scan's own edge is needed and no scan is there");
  EXPECT_EQ(refusal(AddEdit{{.path_mm = std::vector<Vec3>(100'001)}}, ball),
            "add: it has 100001 points; at most 100000 are allowed");
  EXPECT_EQ(refusal(AddEdit{{.path_mm = {Vec3(std::numeric_limits<double>::quiet_NaN())}}}, ball),
            "add: a number of it is not finite, or a number of known_to_mm is negative");
  for (const double far : {1.01e5, -1e9, 1e300}) {  // however far: no memory for the planes between
    const std::string why = "a point of it lies more than 100 m from the origin";
    EXPECT_EQ(refusal(TraceEdit{.points_mm = {Vec3(0), Vec3(0, far, 0)}, .known_to_mm = {}}, ball), "trace: " + why);
    EXPECT_EQ(refusal(RemoveEdit{{.path_mm = {Vec3(far, 0, 0)}}}, ball), "remove: " + why);
    ContoursEdit apart;
    for (const double z : {0.0, 1.0, 2.0, far}) apart.loops_mm.push_back({{0, 0, z}, {9, 0, z}, {0, 9, z}});
    EXPECT_EQ(refusal(apart, nullptr), "contours: " + why);
  }
  EXPECT_EQ(refusal(TraceEdit{.points_mm = {Vec3(9, 0, 0)}, .known_to_mm = {}, .reach_mm = 1000}, ball),
            "trace: reach_mm is 1000 mm; it has to be from 0.2 to 100 mm");
  EXPECT_EQ(refusal(TraceEdit{.points_mm = {Vec3(9, 0, 0)}, .known_to_mm = {1, 2}}, ball),
            "trace: it has 1 points and says of 2 how well they are known: give one for each, or none");
  const auto list = [&](std::size_t count) {
    const std::vector<Edit> edits(count, AddEdit{});
    return palpate::testing::said_when([&] { apply_edits(ball, edits); });
  };
  EXPECT_EQ(list(3), "edit 1: add: it has no points");
  EXPECT_EQ(list(10'001), "there are 10001 edits; at most 10000 are allowed");
}

TEST(Edits, WhatIsTooLargeIsRefusedBeforeItTakesMemory) {
  // A path of 400 mm through nodes of 0.1 mm.
  Geometry scan;
  scan.dimensions = {500, 500, 500};
  for (int k = 0; k < 500; ++k) scan.slice_positions.emplace_back(-250, -250, k - 250);
  DistanceOptions options;
  options.scan = &scan;
  const auto tiny = distance_of(
      made_labels([](const Vec3& at) { return glm::length(at) < 1; }, 2, {.spacing = {0.1, 0.1, 0.1}}), options);
  EXPECT_EQ(refusal(AddEdit{{.path_mm = {Vec3(-200), Vec3(200)}, .radius_mm = 50}}, tiny),
            "add: it changes more than can be kept: divide it into several");
}

/// A ball of 100 in 0, blurred, with noise: an analytic scan.
class BallValues final : public FieldSource {
 public:
  FieldSet available() const noexcept override { return FieldSet::value | FieldSet::gradient; }
  Sample sample(const Vec3& at, FieldSet) const noexcept override {
    const double r = glm::length(at), depth = (12 - r) / 0.8;
    Sample sample;
    sample.inside = true;
    sample.value = 50 * (1 + std::erf(depth / std::sqrt(2.0)));
    sample.gradient =
        r > 0 ? -at / r * (100 / (0.8 * std::sqrt(2 * 3.14159265358979)) * std::exp(-0.5 * depth * depth)) : Vec3(0);
    return sample;
  }
};

TEST(Edits, TheScanEdgeIsTakenWithinItsRadiusAndNoFarther) {
  const auto off = ball_to_edit(12, Vec3(1.5, 0, 0));  // outlined 1.5 mm beside the scan's ball
  const BallValues values;
  Geometry geometry;
  geometry.dimensions = {60, 60, 60};
  for (int k = 0; k < 60; ++k) geometry.slice_positions.emplace_back(-30, -30, k - 30);
  const ScanValues scan{values, geometry};
  const Vec3 center(13.5, 0, 0);
  EditOutcome outcome;
  const auto moved =
      apply_edit(off, ScanEdgeEdit{.center_mm = center, .radius_mm = 10, .most_mm = 3}, {.scan = &scan}, &outcome);
  EXPECT_GT(outcome.points, 20U);
  EXPECT_NEAR(moved->sample(Vec3(12, 0, 0)).mm, 0, 0.2);
  for (const OutlinePlace& place : outline_places(*moved, 2)) {
    if (glm::distance(place.place_mm, center) < 11) continue;
    EXPECT_NEAR(off->sample(place.place_mm).mm, 0, 0.02);
  }
  const auto held =
      apply_edit(off, ScanEdgeEdit{.center_mm = center, .radius_mm = 10, .most_mm = 0.5}, {.scan = &scan}, &outcome);
  EXPECT_GT(outcome.without_edge, 20U);
  EXPECT_NEAR(held->sample(Vec3(13.5, 0, 0)).mm, 0, 0.05);
  EXPECT_EQ(palpate::testing::said_when(
                [&] { apply_edit(off, ScanEdgeEdit{.center_mm = Vec3(0), .radius_mm = 3}, {.scan = &scan}); }),
            "scan_edge: no edge of the structure lies within its radius");
}

TEST(Edits, ContoursMakeANewStructure) {
  ContoursEdit loops;
  for (int k = 0; k < 12; ++k) {
    std::vector<Vec3> loop;
    for (int n = 0; n < 60; ++n) loop.emplace_back(10 * std::cos(0.1047198 * n), 10 * std::sin(0.1047198 * n), 2 * k);
    loops.loops_mm.push_back(loop);
  }
  const std::vector<Edit> edits{loops, RemoveEdit{{.path_mm = {Vec3(10, 0, 11)}, .radius_mm = 3}}};
  const Edited made = apply_edits(nullptr, edits);
  EXPECT_NEAR(made.field->sample(Vec3(-7, 0, 11)).mm, 3, 0.1);
  EXPECT_NEAR(made.field->sample(Vec3(7, 0, 11)).mm, 0, 0.1);
  EXPECT_EQ(made.outcomes[0].points, 720U);
  EXPECT_EQ(refusal(ContoursEdit{{{Vec3(0), Vec3(1, 0, 0), Vec3(2, 0, 0)}}}, nullptr),
            "contours: its contours have no area");
}

}  // namespace
}  // namespace palpate::io
