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
  look.tick.stylus_state = static_cast<std::uint32_t>(fault == Fault::none ? state : State::active);
  return look;
}

TEST(SessionState, EachStateHasItsLine) {
  struct Case {
    State state;
    bool feels;
    SessionState shown;
    const char* words;
    bool lost = false;
  };
  const char* const silent = "Stopped: The stylus does not answer: check its plug and power, then open it again.";
  const Case cases[] = {
      {State::idle, false, SessionState::ready, "Ready: no force. Feel turns it on"},
      {State::ramping, false, SessionState::ready, "Ready: the force is going down"},
      {State::active, false, SessionState::ready, "Ready: the force is going down"},
      {State::idle, true, SessionState::feeling, "Feeling: forces are coming up"},
      {State::ramping, true, SessionState::feeling, "Feeling: forces are coming up"},
      {State::active, true, SessionState::feeling, "Feeling: forces are on"},
      {State::homing, true, SessionState::ready, "Ready: homing, move the stylus as its maker says"},
      {State::disconnected, true, SessionState::stopped, silent, true},
      {State::fault, false, SessionState::stopped, silent, true},
  };
  for (const Case& one : cases) {
    const StateLine line = state_line_of(look_of(one.state, one.feels));
    EXPECT_EQ(line.state, one.shown) << one.words;
    EXPECT_EQ(line.words.toStdString(), one.words);
    EXPECT_FALSE(line.fault_latched) << one.words;
    EXPECT_EQ(line.lost, one.lost) << one.words;
    EXPECT_EQ(line.needs_clearing(), one.lost) << one.words;
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

/// A stylus that is lost at rest latches nothing in the filter, which had no force to take away. It is told what the
/// stylus knows, also while it is clutched, and the stylus can be opened again, whatever else keeps the force off.
TEST(SessionState, OneThatIsLostAtRestIsSaidAndCanBeOpenedAgain) {
  for (const State state : {State::fault, State::disconnected}) {
    for (const bool clutched : {false, true}) {
      for (const char* const trouble : {"The machine slept: open the stylus again.", "Another program pushes it."}) {
        for (const char* const kept_off : {"", "a dialog is open"}) {
          SessionStatus look = look_of(state, false);
          look.clutched = clutched;
          look.trouble = QString::fromUtf8(trouble);
          look.kept_off = QString::fromUtf8(kept_off);
          const StateLine line = state_line_of(look);
          EXPECT_EQ(line.state, SessionState::stopped);
          EXPECT_EQ(line.words.toStdString(), std::string("Stopped: ") + (*kept_off ? kept_off : trouble));
          EXPECT_FALSE(line.fault_latched) << "there is no record of it";
          EXPECT_TRUE(line.lost && line.needs_clearing());
        }
      }
    }
  }
}

/// Said first in each line of a stylus that stopped, and in no other: only a lost one may push unseen.
TEST(SessionState, AForceThatMayStillActIsSaidFirst) {
  const std::string warning = "Stopped: the stylus may still push. Switch its power off. ";
  for (const Fault fault : {Fault::none, Fault::device_lost, Fault::tick_late}) {
    for (const char* const kept_off : {"", "a dialog is open"}) {
      SessionStatus look = look_of(State::fault, false, fault);
      look.tick.stylus_state = static_cast<std::uint32_t>(State::fault);
      look.trouble = QStringLiteral("its plug is out");
      look.kept_off = QString::fromUtf8(kept_off);
      const std::string why = *kept_off ? kept_off : "its plug is out";
      EXPECT_EQ(state_line_of(look).words.toStdString(), "Stopped: " + why);
      look.may_push = true;
      EXPECT_EQ(state_line_of(look).words.toStdString(), warning + why);
      EXPECT_EQ(state_line_of(look).state, SessionState::stopped);
    }
  }
}

/// The session gives its full force, but the link lets it come back by a ramp, or the device is on trial. That has
/// nothing to do with warm motors.
TEST(SessionState, AForceThatIsHeldBackIsNotOnYet) {
  for (const State state : {State::idle, State::ramping, State::active}) {
    for (const bool warm : {false, true}) {
      SessionStatus look = look_of(state, true);
      look.is_held_back = true;
      look.is_warm = warm;
      look.force_n = 0.2;
      EXPECT_EQ(state_line_of(look).state, SessionState::feeling);
      EXPECT_EQ(state_line_of(look).words.toStdString(), "Feeling: forces are coming up");
      look.feels = false;
      EXPECT_EQ(state_line_of(look).state, SessionState::ready);
    }
  }
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
