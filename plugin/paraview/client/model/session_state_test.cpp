// The line of the state: for each state of the device, with and without forces turned on, and each reason to stop.

#include "plugin/paraview/client/model/session_state.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "device/safety/safety_filter.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/session/session.h"

namespace palpate::plugin {
namespace {

using device::Fault;
using State = device::State;

SessionStatus look_of(State state, bool feels, Fault fault = Fault::none) {
  SessionStatus look;
  look.connected = look.fresh = true;
  look.feels = feels;
  look.tick.safety = pack_safety(state, fault);
  look.tick.stylus_state = static_cast<std::uint32_t>(State::active);
  return look;
}

TEST(SessionState, EachStateHasItsLine) {
  struct Case {
    State state;
    bool feels;
    SessionState shown;
    const char* words;
  };
  const Case cases[] = {
      {State::idle, false, SessionState::ready, "Ready: no force. Feel turns it on"},
      {State::ramping, false, SessionState::ready, "Ready: the force is going down"},
      {State::active, false, SessionState::ready, "Ready: the force is going down"},
      {State::idle, true, SessionState::feeling, "Feeling: forces are coming up"},
      {State::ramping, true, SessionState::feeling, "Feeling: forces are coming up"},
      {State::active, true, SessionState::feeling, "Feeling: forces are on"},
      {State::homing, true, SessionState::ready, "Ready: homing, move the stylus as its maker says"},
      {State::disconnected, true, SessionState::stopped,
       "Stopped: the stylus does not answer. Check its plug and power, then connect it again"},
      {State::fault, false, SessionState::stopped,
       "Stopped: the stylus does not answer. Check its plug and power, then connect it again"},
  };
  for (const Case& one : cases) {
    const StateLine line = state_line_of(look_of(one.state, one.feels));
    EXPECT_EQ(line.state, one.shown) << one.words;
    EXPECT_EQ(line.words.toStdString(), one.words);
    EXPECT_FALSE(line.fault_latched || line.lost) << one.words;
  }
}

TEST(SessionState, WithoutAStylusOrATickNothingIsSaidOfForces) {
  SessionStatus look = look_of(State::active, true);
  look.connected = false;
  EXPECT_EQ(state_line_of(look).state, SessionState::off);
  EXPECT_EQ(state_line_of(look).words.toStdString(), "Off: no stylus is connected");
  look.connected = true;
  look.fresh = false;
  look.tick.safety = pack_safety(State::fault, Fault::device_lost);  // of the session before
  EXPECT_EQ(state_line_of(look).state, SessionState::ready);
  EXPECT_EQ(state_line_of(look).words.toStdString(), "Ready: the stylus is starting");
  EXPECT_FALSE(state_line_of(look).fault_latched);
}

TEST(SessionState, HowToHomeIsTheDevicesOwn) {
  SessionStatus look = look_of(State::homing, false);
  look.homing = QStringLiteral("press the red button");
  EXPECT_EQ(state_line_of(look).words.toStdString(), "Ready: to home it, press the red button");
}

TEST(SessionState, AClutchedStylusIsReady) {
  SessionStatus look = look_of(State::active, true);
  look.clutched = true;
  EXPECT_EQ(state_line_of(look).state, SessionState::ready);
  EXPECT_TRUE(state_line_of(look).words.startsWith("Ready: clutched"));
}

/// Less acts than was asked for: the panel shows what acts, and says why.
TEST(SessionState, WarmMotorsAreSaid) {
  SessionStatus look = look_of(State::active, true);
  look.is_warm = true;
  look.force_n = 0.88;
  EXPECT_EQ(state_line_of(look).state, SessionState::feeling);
  EXPECT_EQ(state_line_of(look).words.toStdString(), "Feeling: the motors are warm, so the force is only 0.9 N");
  look.feels = false;
  EXPECT_NE(state_line_of(look).state, SessionState::feeling);
}

/// Whatever keeps the force off is said first; whether a fault has to be cleared, too, is told beside it.
TEST(SessionState, WhatKeepsTheForceOffIsSaid) {
  for (const Fault fault : {Fault::none, Fault::tick_late}) {
    SessionStatus look = look_of(State::active, true, fault);
    look.kept_off = QStringLiteral("a dialog is open");
    const StateLine line = state_line_of(look);
    EXPECT_EQ(line.state, SessionState::stopped);
    EXPECT_EQ(line.words.toStdString(), "Stopped: a dialog is open");
    EXPECT_EQ(line.fault_latched, fault != Fault::none);
  }
}

/// Each fault has its advice; what the stylus itself knows replaces it only where the stylus is lost.
TEST(SessionState, EachFaultIsSaidWithItsAdvice) {
  for (const Fault fault : {Fault::device_lost, Fault::tick_late, Fault::commander_silent, Fault::force_not_finite}) {
    for (const State stylus :
         {State::idle, State::homing, State::ramping, State::active, State::fault, State::disconnected}) {
      for (const char* const trouble : {"", "its plug is out"}) {
        SessionStatus look = look_of(State::active, true, fault);
        look.tick.stylus_state = static_cast<std::uint32_t>(stylus);
        look.trouble = QString::fromUtf8(trouble);
        const StateLine line = state_line_of(look);
        const bool lost = stylus == State::fault || stylus == State::disconnected;
        EXPECT_EQ(line.state, SessionState::stopped);
        EXPECT_TRUE(line.fault_latched);
        EXPECT_EQ(line.lost, lost);
        const std::string why = lost && *trouble ? std::string(trouble) : std::string(device::advice_for(fault));
        EXPECT_EQ(line.words.toStdString(), "Stopped: " + why);
      }
    }
  }
}

}  // namespace
}  // namespace palpate::plugin
