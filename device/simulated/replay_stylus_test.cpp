#include "device/simulated/replay_stylus.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace palpate::device {
namespace {

TEST(ReplayStylus, ReturnsEachReadingOnceThenTheLastNotFresh) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Reading readings[] = {{0, {1, 2, 3}, 0, true},
                              {0.001, {1, 2, 3}, 4, false},
                              {0.002, {nan, 0, 0}, 0, true},
                              {0.003, {7, 8, 9}, 1, true}};
  ReplayStylus stylus(readings);
  EXPECT_EQ(stylus.state(), State::disconnected);
  for (int pass = 0; pass < 2; ++pass) {
    stylus.open();
    EXPECT_EQ(stylus.last_force(), Vec3(0));
    for (const Reading& expected : readings) {
      EXPECT_FALSE(stylus.finished());
      const Reading got = stylus.read();
      EXPECT_EQ(got.time, expected.time);
      EXPECT_EQ(got.buttons, expected.buttons);
      EXPECT_EQ(got.fresh, expected.fresh);
      EXPECT_EQ(got.position.y, expected.position.y);
      EXPECT_EQ(got.position.x != got.position.x, expected.position.x != expected.position.x);
      stylus.write_force(Vec3(0, got.time, 0));
      EXPECT_EQ(stylus.last_force().y, expected.time);
    }
    EXPECT_TRUE(stylus.finished());
    EXPECT_EQ(stylus.read().position, Vec3(7, 8, 9));
    EXPECT_FALSE(stylus.read().fresh);
    if (pass == 1) stylus.close();  // opened anew without that it begins anew, too
  }
  EXPECT_EQ(stylus.last_force(), Vec3(0));
}

TEST(ReplayStylus, RefusesAnEmptyRecording) {
  EXPECT_THROW(ReplayStylus({}).open(), std::runtime_error);
  EXPECT_FALSE(ReplayStylus({}).read().fresh);
}

TEST(ReplayStylus, RepeatsTheStatesToo) {
  const Reading readings[] = {{0, {}, 0, true}, {0.001, {}, 0, true}, {0.002, {}, 0, false}};
  const State states[] = {State::homing, State::active, State::fault};
  ReplayStylus stylus(readings, states);
  EXPECT_EQ(stylus.state(), State::disconnected);
  stylus.open();
  for (const State expected : states) {
    stylus.read();
    EXPECT_EQ(stylus.state(), expected);
    stylus.write_force(Vec3(0));
  }
  EXPECT_EQ(stylus.state(), State::fault) << "the last, from then on";
  stylus.close();
  EXPECT_EQ(stylus.state(), State::disconnected);
  EXPECT_THROW(ReplayStylus(readings, std::span(states).first(2)), std::logic_error);
}

}  // namespace
}  // namespace palpate::device
