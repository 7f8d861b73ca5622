/// What an axis check concludes, for everything that the hand may say and the pose may do: by its documents' table.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <vector>

#include "device/check/axis_check.h"

namespace palpate::device {
namespace {

/// A stylus that moves as it is told to while it is pushed along an axis, however small the force.
class MovingStylus : public Stylus {
 public:
  Specification specification() const override { return {.name = "one that moves", .maximum_force = 3}; }
  void open() override {}
  void close() noexcept override {}
  Reading read() noexcept override { return {.time = time, .position = place, .fresh = true}; }
  void write_force(const Vec3& force) noexcept override {
    last = force;
    if (glm::length(force) > glm::length(strongest)) strongest = force;
    for (int axis = 0; axis < 3; ++axis) place[axis] = force[axis] > 0 ? moves[axis] : 0;
  }
  State state() const noexcept override { return time < homed_at ? State::homing : State::idle; }
  double next() { return time += 1e-3; }

  double time = 100, homed_at = 0;
  Vec3 place{0}, moves{0}, strongest{0}, last{1};
};

AxisHand hand_that_says(Felt felt) {
  return {
      .ready = [](const AxisPush&) { return true; }, .felt = [felt](const AxisPush&) { return felt; }, .home = [] {}};
}

/// Felt the other way: the force's sign is -1. Moved the other way than was felt, by 0.3 mm at least: the position's
/// is.
TEST(AxisLimits, TheSignsAreOfWhatWasFeltAndMoved) {
  for (const Felt felt : {Felt::as_said, Felt::opposite, Felt::nothing}) {
    for (const double mm : {-2.0, -0.301, -0.299, 0.0, 0.299, 0.301, 2.0}) {
      for (int axis = 0; axis < 3; ++axis) {
        MovingStylus stylus;
        stylus.moves[axis] = 1e-3 * mm;
        const AxisHand hand{.ready = [](const AxisPush&) { return true; },
                            .felt =
                                [&](const AxisPush& push) {
                                  EXPECT_EQ(push.force, 0.2);
                                  EXPECT_EQ(push.moved, push.axis == axis ? 1e-3 * mm : 0);
                                  return push.axis == axis ? felt : Felt::nothing;
                                },
                            .home = [] {}};
        const AxisCheck check = check_axes(stylus, hand, [&] { return stylus.next(); });
        Vec3 force(1), position(1);
        if (felt == Felt::opposite) force[axis] = -1;
        if (felt != Felt::nothing && std::abs(mm) > 0.3 && (mm > 0) != (felt == Felt::as_said)) position[axis] = -1;
        EXPECT_EQ(check.signs.force, force);
        EXPECT_EQ(check.signs.position, position) << mm << " " << static_cast<int>(felt);
        EXPECT_EQ(check.moved[static_cast<std::size_t>(axis)], 1e-3 * mm);
        EXPECT_EQ(check.felt[static_cast<std::size_t>(axis)], felt);
        EXPECT_FALSE(check.ended);
        EXPECT_FALSE(check.is_right()) << "two axes were not felt";
      }
    }
  }
}

/// What a pose that is right says of the hand.
TEST(AxisLimits, APoseThatIsRightSaysWhatWasFelt) {
  for (const double mm : {-2.0, -0.301, -0.299, 0.0, 0.299, 0.301, 2.0}) {
    const Felt felt = std::abs(mm) < 0.3 ? Felt::nothing : mm > 0 ? Felt::as_said : Felt::opposite;
    const AxisPush push{.axis = 1, .force = 0.2, .moved = 1e-3 * mm};
    EXPECT_EQ(felt_by_pose(push), felt) << mm;
    EXPECT_EQ(felt_by_pose(push, 1e-3) == Felt::nothing, std::abs(mm) < 1);
  }
}

/// All is right only where all of it is.
TEST(AxisLimits, OneThingAmissIsNotRight) {
  AxisCheck good;
  good.felt.fill(Felt::as_said);
  EXPECT_TRUE(good.is_right());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const Felt felt : {Felt::opposite, Felt::nothing, Felt::stop}) {
      AxisCheck one = good;
      one.felt[axis] = felt;
      EXPECT_FALSE(one.is_right());
    }
    AxisCheck one = good;
    one.signs.position[static_cast<int>(axis)] = -1;
    EXPECT_FALSE(one.is_right());
  }
  AxisCheck ended = good, faulty = good;
  ended.ended = true;
  faulty.fault = Fault::device_silent;
  EXPECT_FALSE(ended.is_right());
  EXPECT_FALSE(faulty.is_right());
}

/// A push along each axis with the force that was set, and none left after it.
TEST(AxisLimits, PushesWithTheForceThatWasSet) {
  for (const double newtons : {0.05, 0.2, 1.5}) {
    std::vector<Vec3> strongest;
    MovingStylus stylus;
    const AxisHand hand{.ready =
                            [&](const AxisPush& push) {
                              EXPECT_EQ(push.force, newtons);
                              stylus.strongest = Vec3(0);
                              return true;
                            },
                        .felt =
                            [&](const AxisPush&) {
                              strongest.push_back(stylus.strongest);
                              EXPECT_EQ(stylus.last, Vec3(0)) << "it has fallen";
                              return Felt::as_said;
                            },
                        .home = [] {}};
    check_axes(stylus, hand, [&] { return stylus.next(); }, {.force = newtons});
    ASSERT_EQ(strongest.size(), 3U);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 wanted(0);
      wanted[axis] = newtons;
      EXPECT_LT(glm::distance(strongest[static_cast<std::size_t>(axis)], wanted), 1e-12);
    }
    EXPECT_EQ(stylus.last, Vec3(0));
  }
}

/// The ramp of a push takes 0.3 s, so that its second half has the whole force.
TEST(AxisLimits, APushSwellsInThreeTenthsOfASecond) {
  MovingStylus stylus;
  double begun = 0, full = 0;
  const AxisHand hand{.ready =
                          [&](const AxisPush& push) {
                            if (push.axis == 0) begun = stylus.time + 0.2;
                            return push.axis == 0;
                          },
                      .felt = [](const AxisPush&) { return Felt::as_said; },
                      .home = [] {}};
  const AxisCheck check = check_axes(stylus, hand, [&] {
    if (full == 0 && stylus.last.x > 0.1999 && stylus.last.y == 0) full = stylus.time;
    return stylus.next();
  });
  EXPECT_NEAR(full - begun, 0.3, 0.005);
  EXPECT_TRUE(check.ended) << "the user ended it before the second axis";
  EXPECT_FALSE(check.is_right());
}

/// A stylus that has to be homed is waited for as long as the user has; he is told so once. One whose first pose is a
/// moment late has its home.
TEST(AxisLimits, WaitsForTheHomeAsLongAsTheUserHas) {
  for (const double homes_s : {0.0, 0.06, 0.45, 1.9, 2.5}) {
    MovingStylus stylus;
    stylus.homed_at = homes_s == 0 ? 0 : stylus.time + homes_s;
    int told = 0;
    AxisHand hand = hand_that_says(Felt::nothing);
    hand.home = [&] { ++told; };
    const double begun = stylus.time;
    const AxisCheck check = check_axes(stylus, hand, [&] { return stylus.next(); }, {.homing_time = 2});
    EXPECT_EQ(told, homes_s < 0.1 ? 0 : 1) << homes_s;
    EXPECT_EQ(check.ended, homes_s > 2) << homes_s;
    if (homes_s > 2) {
      EXPECT_NEAR(stylus.time - begun, 2, 0.11);
    }
    EXPECT_EQ(stylus.strongest == Vec3(0), homes_s > 2);
  }
  EXPECT_EQ(AxisCheckSettings{}.homing_time, 60);
  EXPECT_EQ(AxisCheckSettings{}.smallest, 0.3e-3);
}

TEST(AxisLimits, EachDirectionHasItsName) {
  EXPECT_EQ(std::string(name_of_direction(0)), "to the right");
  EXPECT_EQ(std::string(name_of_direction(1)), "up");
  EXPECT_EQ(std::string(name_of_direction(2)), "towards you");
}

}  // namespace
}  // namespace palpate::device
