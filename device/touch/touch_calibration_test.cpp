#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "device/testing/touch_fixture.h"

namespace palpate::device {
namespace {

class TouchCalibration : public TouchFixture {};

TEST_F(TouchCalibration, PushesNothingBeforeItIsCalibrated) {
  hd->calibration = hd->after_update = 0x5002;  // by hand: the inkwell
  const auto stylus = unthreaded();
  stylus->open();
  EXPECT_FALSE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() != Vec3(0); }));
  EXPECT_EQ(stylus->state(), State::homing);
  hd->calibration = 0x5000;
  EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
  EXPECT_EQ(stylus->state(), State::idle);
}

TEST_F(TouchCalibration, CalibratesItselfWhereItCan) {
  hd->calibration = 0x5001;
  const auto stylus = unthreaded();
  stylus->open();
  EXPECT_TRUE(comes(*stylus, Vec3(0), [&] { return stylus->state() == State::idle; }));
}

/// Its home would move under the hand.
TEST_F(TouchCalibration, IsNotCalibratedAnewOnceItPushed) {
  for (const int styles : {1, 4, 1 | 4}) {
    *hd = FakeHd{};
    hd->styles = styles;
    const auto stylus = unthreaded();
    stylus->open();
    ASSERT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
    hd->calibration = 0x5001;
    EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return stylus->state() == State::fault; }));
    EXPECT_EQ(stylus->fault(), LinkFault::unhomed);
    EXPECT_EQ(hd->calibration, 0x5001U);
    EXPECT_EQ(acting(), Vec3(0));
  }
}

/// An automatic calibration gathers figures as the arm moves, and says so: no fault, and nothing is taken over as long
/// as it pushes.
TEST_F(TouchCalibration, AnAutomaticCalibrationRefinesItselfWhileNothingPushes) {
  hd->styles = 2 | 4;
  const auto stylus = unthreaded();
  stylus->open();
  ASSERT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
  hd->calibration = 0x5001;
  EXPECT_FALSE(comes(*stylus, Vec3(0, 1, 0), [&] { return stylus->state() != State::idle || hd->updates > 0; }));
  EXPECT_EQ(acting(), Vec3(0, 1, 0)) << "it goes on as it was";
  EXPECT_TRUE(comes(*stylus, Vec3(0), [&] { return hd->updates == 1; }));
  EXPECT_EQ(hd->update_force, 0) << "N, that acted meanwhile";
  EXPECT_EQ(hd->style, 2U);
  EXPECT_EQ(stylus->fault(), LinkFault::none);
  EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return acting() == Vec3(0, 1, 0); }));
  hd->calibration = 0x5002;
  EXPECT_TRUE(comes(*stylus, Vec3(0, 1, 0), [&] { return stylus->fault() == LinkFault::unhomed; })) << "that is lost";
}

/// One style of those that the device has: automatic before inkwell before a reset of its encoders.
TEST_F(TouchCalibration, IsCalibratedByOneStyle) {
  for (int styles = 1; styles < 8; ++styles) {
    *hd = FakeHd{};
    hd->styles = styles;
    hd->calibration = 0x5001;
    const auto stylus = unthreaded({.may_reset_encoders = true});
    stylus->open();
    EXPECT_TRUE(comes(*stylus, Vec3(0), [&] { return stylus->state() == State::idle; })) << styles;
    EXPECT_EQ(hd->style, (styles & 2) != 0 ? 2U : (styles & 4) != 0 ? 4U : 1U) << styles;
    EXPECT_EQ(hd->updates, 1) << styles;
  }
}

/// A reset takes any place of the arm for its zero: nobody's arm is reset before it was allowed.
TEST_F(TouchCalibration, ItsEncodersAreResetOnlyWhenTheyMay) {
  hd->styles = 1;
  hd->calibration = 0x5002;
  expect_refusal([] { unthreaded()->open(); },
                 "3D Systems Touch: this model uses the position in which it is reset as its zero; put its links at "
                 "right angles, then allow it in its settings file: may_reset_encoders, true");
  EXPECT_EQ(hd->updates, 0);
  EXPECT_EQ(hd->disabled, 1);
  unthreaded({.may_reset_encoders = true})->open();
  EXPECT_EQ(hd->updates, 1);
  EXPECT_EQ(hd->style, 1U);
  EXPECT_EQ(hd->running, 0) << "before its servo loop runs; the stylus of this line is gone";
  unthreaded()->open();
  EXPECT_EQ(hd->updates, 1) << "it has its zero";
}

TEST_F(TouchCalibration, AResetThatFailsIsSaid) {
  hd->styles = 1;
  hd->calibration = 0x5002;
  hd->error = 0x303;
  std::strcpy(hd->failing_call, "hdUpdateCalibration");
  expect_refusal([] { unthreaded({.may_reset_encoders = true})->open(); },
                 "it does not tell what it can do: a fault of the fake");
  EXPECT_EQ(hd->disabled, 1);
  EXPECT_EQ(hd->running, 0);
}

}  // namespace
}  // namespace palpate::device
