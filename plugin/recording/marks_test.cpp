// Presses of the mark button on paths whose positions and lengths are known by construction.

#include "plugin/recording/marks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace palpate::plugin {
namespace {

modes::Scene skin_and_bone() {
  modes::Scene scene;
  scene.modes.push_back({.type = "surface", .name = "skin"});
  scene.modes.push_back({.type = "surface"});
  scene.modes.push_back({.type = "friction", .name = "friction"});
  scene.modes.push_back({.type = "force", .name = "push"});
  scene.modes.push_back({.type = "keep_out", .name = "liver"});
  scene.modes.push_back({.type = "landmark", .name = "entry"});
  return scene;
}

struct Hand {
  const modes::Scene scene = skin_and_bone();
  MarkPresses presses;
  std::uint64_t tick = 0;
  double step_s = 1e-3;

  std::optional<MarkMade> at(const glm::dvec3& place, bool down, const std::vector<PrimitiveRecord>& shares = {}) {
    TickRecord record;
    record.index = tick;
    record.time_s = step_s * static_cast<double>(tick++);
    record.value = 41;
    record.sent_n[1] = -0.5;
    record.buttons = down ? mark_button : 1;  // the first button marks nothing
    return presses.take({.tick = record, .time_s = record.time_s, .proxy_mm = place, .shares = shares, .scene = scene});
  }
};

Marks three_marks() {
  Marks marks;
  for (const glm::dvec3& at : {glm::dvec3(0, 0, 0), glm::dvec3(3, 4, 0), glm::dvec3(3, 4, 12)}) {
    marks.points.push_back({.name = free_mark_name(marks), .position_mm = at});
  }
  return marks;
}

TEST(MarkPresses, AShortPressIsAMarkWhereItBegan) {
  Hand hand;
  PrimitiveRecord weak, strong;
  weak.mode = 1;
  weak.force_n[0] = 0.1;
  strong.mode = 0;
  strong.force_n[2] = -0.4;
  EXPECT_FALSE(hand.at({9, 9, 9}, false));
  EXPECT_FALSE(hand.at({1, 2, 3}, true, {weak, strong}));
  EXPECT_FALSE(hand.at({1, 2, 4.9}, true));  // a hand that presses a button moves a little
  const auto made = hand.at({50, 50, 50}, false);
  ASSERT_TRUE(made && std::holds_alternative<FeltMark>(*made));
  const auto& mark = std::get<FeltMark>(*made);
  EXPECT_EQ(mark.position_mm, glm::dvec3(1, 2, 3));
  EXPECT_EQ(mark.tick, 1U);
  EXPECT_EQ(mark.time_s, 1e-3);
  EXPECT_EQ(mark.boundary, "skin");
  EXPECT_EQ(mark.value, 41);
  EXPECT_EQ(mark.force_n, 0.5);
  EXPECT_FALSE(hand.at({1, 2, 3}, false)) << "and it is made once";
}

TEST(MarkPresses, KeptDownWhileItMovesItIsAPathAsLongAsItsWay) {
  Hand hand;
  std::optional<MarkMade> made;
  constexpr int steps = 3000;
  constexpr double radius_mm = 30;
  const auto place = [](int n) {
    const double turned = std::numbers::pi * n / steps;
    return radius_mm * glm::dvec3(std::cos(turned), std::sin(turned), 0);
  };
  for (int n = 0; n <= steps; ++n) EXPECT_FALSE(hand.at(place(n), true));
  made = hand.at({0, 0, 0}, false);
  ASSERT_TRUE(made && std::holds_alternative<MarkedPath>(*made));
  const auto& path = std::get<MarkedPath>(*made);
  EXPECT_NEAR(path.length_mm, std::numbers::pi * radius_mm, 0.01);
  EXPECT_EQ(path.points_mm.front(), place(0));
  EXPECT_EQ(path.points_mm.back(), place(steps));
  EXPECT_NEAR(path.end_s - path.begin_s, 3, 1e-9);
}

/// What is felt everywhere, and what is too faint to be felt, is no boundary; nor is a mode of the scene before.
TEST(MarkPresses, SayWhichBoundaryHeldAndThatNoneDid) {
  struct Case {
    std::uint32_t mode;
    double force_n;
    const char* boundary;
  };
  for (const Case& one : {Case{0, 0.06, "skin"}, Case{0, 0.04, ""}, Case{2, 3, ""}, Case{3, 3, ""}, Case{4, 3, "liver"},
                          Case{5, 3, "entry"}, Case{7, 3, ""}}) {
    Hand hand;
    PrimitiveRecord share;
    share.mode = one.mode;
    share.force_n[1] = one.force_n;
    hand.at({1, 2, 3}, true, {share});
    const auto made = hand.at({1, 2, 3}, false);
    EXPECT_EQ(std::get<FeltMark>(made.value()).boundary, one.boundary) << one.mode << ", " << one.force_n << " N";
  }
}

TEST(MarkPresses, TellHowMuchOfAPathWasInContact) {
  for (const auto& [held_steps, contact] :
       {std::pair{0, PathContact::nowhere}, {50, PathContact::partly}, {100, PathContact::all_along}}) {
    Hand hand{.step_s = 0.01};
    PrimitiveRecord skin, friction;
    skin.force_n[1] = 0.5;
    friction.mode = 2;
    friction.force_n[1] = 0.5;
    hand.at({0, 0, 0}, true, {friction});
    for (int n = 1; n <= 100; ++n) {
      hand.at({0.3 * n, 0, 0}, true, n <= held_steps ? std::vector{skin, friction} : std::vector{friction});
    }
    const auto made = hand.presses.finish();
    const auto& path = std::get<MarkedPath>(made.value());
    EXPECT_NEAR(path.touched_mm, 0.3 * held_steps, 1e-9);
    EXPECT_EQ(contact_of(path), contact) << held_steps;
  }
  EXPECT_EQ(contact_of({.length_mm = 3, .touched_mm = std::nan("")}), PathContact::unknown);
}

TEST(MarkPresses, ATapIsAMarkHoweverFastTheHandMoves) {
  for (const double tap_s : {0.05, 0.24, 0.26, 1.0}) {
    Hand hand;
    hand.step_s = tap_s / 100;
    for (int n = 0; n <= 100; ++n) hand.at({0.1 * n, 0, 0}, true);
    const auto made = hand.at({10, 0, 0}, false);
    ASSERT_TRUE(made);
    EXPECT_EQ(std::holds_alternative<FeltMark>(*made), tap_s < 0.25) << tap_s;
    if (tap_s < 0.25) {
      EXPECT_EQ(std::get<FeltMark>(*made).position_mm, glm::dvec3(0, 0, 0));
    }
  }
}

TEST(MarkPresses, TremorAddsNothingToAPath) {
  Hand hand{.step_s = 0.01};
  for (int n = 0; n <= 100; ++n) hand.at({0.1 * n, n % 2 == 0 ? 0.0 : 0.05, 0}, true);
  const auto made = hand.presses.finish();
  ASSERT_TRUE(made && std::holds_alternative<MarkedPath>(*made));
  EXPECT_NEAR(std::get<MarkedPath>(*made).length_mm, 10, 0.1);
}

TEST(MarkPresses, WhatIsDroppedMakesNothing) {
  Hand hand;
  hand.at({1, 2, 3}, true);
  hand.presses.drop();
  EXPECT_FALSE(hand.at({1, 2, 3}, false));
}

TEST(Marks, AreMeasuredByTheirPlaces) {
  Marks marks = three_marks();
  EXPECT_EQ(marks.points[2].name, "Mark 3");
  EXPECT_DOUBLE_EQ(distance_mm(marks, 0, 1), 5);
  EXPECT_DOUBLE_EQ(distance_mm(marks, 0, 2), 13);
  EXPECT_NEAR(*angle_degrees(marks, 0, 1, 2), 90, 1e-9);
  EXPECT_NEAR(*angle_degrees(marks, 1, 0, 2), std::atan2(12, 5) * 180 / std::numbers::pi, 1e-9);
  marks.distances = {{.from = 0, .to = 2}};
  marks.angles = {{.from = 0, .at = 1, .to = 2}};
  marks.points[2].position_mm = {3, 4, 0};  // where the second is
  measure_again(marks);
  EXPECT_DOUBLE_EQ(marks.distances[0].mm, 5);
  EXPECT_TRUE(marks.angles.empty()) << "two marks at one place have no angle";
}

TEST(Marks, WhatLiesBetweenThemGoesWithThem) {
  Marks marks = three_marks();
  marks.distances = {{.from = 0, .to = 1}, {.from = 1, .to = 2}, {.from = 0, .to = 2}};
  marks.angles = {{.from = 0, .at = 1, .to = 2}};
  remove_mark(marks, 1);
  measure_again(marks);
  ASSERT_EQ(marks.points.size(), 2U);
  EXPECT_EQ(marks.points[1].name, "Mark 3");
  ASSERT_EQ(marks.distances.size(), 1U);
  EXPECT_EQ(marks.distances[0].to, 1U) << "the third is the second now";
  EXPECT_DOUBLE_EQ(marks.distances[0].mm, 13);
  EXPECT_TRUE(marks.angles.empty());
  EXPECT_EQ(free_mark_name(marks), "Mark 2") << "the name is free again";
}

/// A hand that moves by more than 2 mm while it presses draws a path; its points are 0.2 mm apart and more, and the
/// last is where it let go.
TEST(MarkPresses, TwoMillimetersTellAMarkFromAPath) {
  for (const double moved_mm : {1.99, 2.01}) {
    Hand hand{.step_s = 0.2};
    hand.at({0, 0, 0}, true);
    hand.at({0, moved_mm, 0}, true);
    hand.at({0, 0.1, 0}, true);
    const auto made = hand.at({9, 9, 9}, false);
    ASSERT_TRUE(made);
    EXPECT_EQ(std::holds_alternative<MarkedPath>(*made), moved_mm > 2) << moved_mm;
  }
  const auto points_of = [](std::initializer_list<double> way) {
    Hand hand{.step_s = 0.2};
    for (const double x : way) hand.at({x, 0, 0}, true);
    const auto made = hand.presses.finish();
    std::vector<double> places;
    for (const glm::dvec3& point : std::get<MarkedPath>(made.value()).points_mm) places.push_back(point.x);
    return places;
  };
  EXPECT_EQ(points_of({0.0, 0.19, 0.21, 0.40, 3.0, 3.1}), (std::vector<double>{0, 0.21, 3, 3.1}));
  EXPECT_EQ(points_of({0.0, 0.2, 0.3, 3.0}), (std::vector<double>{0, 0.2, 3})) << "0.2 mm is a step";
}

/// A twentieth of a path's length is allowed at its ends, however long it is.
TEST(Marks, ATwentiethOfAPathIsAsGoodAsNothing) {
  for (const double length_mm : {0.5, 3.0, 40.0, 100.0, 900.0}) {
    for (const auto& [part, contact] : {std::pair{0.0, PathContact::nowhere},
                                        {0.04, PathContact::nowhere},
                                        {0.06, PathContact::partly},
                                        {0.5, PathContact::partly},
                                        {0.94, PathContact::partly},
                                        {0.96, PathContact::all_along},
                                        {1.0, PathContact::all_along}}) {
      EXPECT_EQ(contact_of({.length_mm = length_mm, .touched_mm = part * length_mm}), contact)
          << part << " of " << length_mm;
    }
  }
}

}  // namespace
}  // namespace palpate::plugin
