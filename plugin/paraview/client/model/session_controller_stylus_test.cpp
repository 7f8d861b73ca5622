// A stylus behind a real socket: its buttons, its orientation, and what happens when it is lost.

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>

#include "device/testing/haply_server.h"
#include "plugin/paraview/client/model/session_state.h"
#include "plugin/paraview/client/model/testing/controlled_session.h"
#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

using testing::comes;

struct SessionOfAStylus : testing::ControlledSession {
  SessionOfAStylus() {
    setenv("XDG_STATE_HOME", state.c_str(), 1);
    device::FakeHaply service;
    service.buttons = 0;
    server.emplace(service);
    std::ofstream(settings) << R"({"host": "127.0.0.1", "port": )" << server->port() << "}";
  }
  ~SessionOfAStylus() override {
    session.disconnect_stylus();
    unsetenv("XDG_STATE_HOME");
  }
  bool is_connected() {
    session.connect_stylus({.device = "haply", .settings = settings});
    return session.live().is_connected() && comes([this] { return last().fresh; });
  }
  void hold_down(std::uint32_t buttons) {
    server->with([buttons](device::FakeHaply& service) { service.buttons = buttons; });
  }
  bool holds_down(std::uint32_t buttons) {
    hold_down(buttons);
    return comes([this, buttons] { return last().tick.buttons == buttons; });
  }
  /// On a busy machine the service may be late, which is a fault: then again.
  bool is_felt() {
    for (int n = 0; n < 20; ++n) {
      session.feel();
      if (!comes([this] { return last().feels || state_line_of(last()).fault_latched; })) return false;
      if (last().feels) return true;
      session.clear_fault();
      if (!comes([this] { return state_line_of(last()).state == SessionState::ready; })) return false;
    }
    return false;
  }

  /// In the patient, mm. The service's z points up.
  void put(const glm::dvec3& place_mm) {
    const glm::dvec3 m = last().workspace.to_device(place_mm);
    server->with([m](device::FakeHaply& service) { service.place = {m.x, -m.z, m.y}; });
  }
  /// Pressed slowly into the skin, until it pushes by more than 0.3 N; again if it was late meanwhile.
  bool is_pushed() {
    if (!is_connected()) return false;
    for (int n = 0; n < 20; ++n) {
      put(outside);
      if (!comes([this] { return is_near(outside); }) || !is_felt()) return false;
      double deep_mm = 0;
      const bool ended = comes([&] {
        if (last().force_n < 0.3 && deep_mm < 9) put(outside + glm::dvec3(0, deep_mm += 0.02, 0));
        return state_line_of(last()).fault_latched || (last().force_n > 0.3 && !last().is_held_back);
      });
      if (!ended) return false;
      if (last().feels) return true;
      session.clear_fault();
      if (!comes([this] { return state_line_of(last()).state == SessionState::ready; })) return false;
    }
    return false;
  }

  std::string state = std::filesystem::absolute(testing::fresh_path("stylus_state"));
  std::string settings = testing::fresh_path("stylus.json").string();
  std::optional<device::HaplyServer> server;
};

TEST_F(SessionOfAStylus, ItsButtonsClutchMarkAndRelease) {
  ASSERT_TRUE(is_connected());
  EXPECT_FALSE(session.has_simulated());
  EXPECT_FALSE(session.takes_mouse());
  ASSERT_TRUE(is_felt());
  ASSERT_TRUE(holds_down(4));
  EXPECT_TRUE(comes([this] { return !last().feels; })) << "released";
  EXPECT_FALSE(session.is_clutched());
  ASSERT_TRUE(holds_down(0));
  ASSERT_TRUE(is_felt());
  ASSERT_TRUE(holds_down(1));
  EXPECT_TRUE(comes([this] { return session.is_clutched(); }));
  EXPECT_EQ(unclutches, 0);
  ASSERT_TRUE(holds_down(3));
  ASSERT_TRUE(holds_down(1));
  ASSERT_TRUE(holds_down(0));
  EXPECT_TRUE(comes([this] { return unclutches == 1; }));
  session.unclutch(last().workspace.rotation);
  ASSERT_TRUE(comes([this] { return last().feels; })) << "as before the clutch";
  // A key that is both is the clutch.
  ASSERT_TRUE(holds_down(5));
  EXPECT_TRUE(comes([this] { return session.is_clutched(); }));
  ASSERT_TRUE(holds_down(0));
  session.unclutch(last().workspace.rotation);
  EXPECT_TRUE(comes([this] { return last().feels; }));
  polls(3);
  EXPECT_TRUE(marks.empty()) << "what is pressed while hand and patient are parted is no mark";
  ASSERT_TRUE(holds_down(2));
  ASSERT_TRUE(holds_down(0));
  EXPECT_TRUE(comes([this] { return marks.size() == 1; }));
}

/// A contact that bounces between two polls, or a panel that was busy: the button is down at the end.
TEST_F(SessionOfAStylus, AClutchButtonThatIsDownHoldsTheClutch) {
  ASSERT_TRUE(is_connected());
  ASSERT_TRUE(is_felt());
  for (const std::uint32_t buttons : {1U, 0U, 1U}) {
    hold_down(buttons);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // no poll comes in between
  }
  EXPECT_TRUE(comes([this] { return session.is_clutched(); }));
  polls(5);
  EXPECT_EQ(unclutches, 0);
  EXPECT_FALSE(last().feels);
  ASSERT_TRUE(holds_down(0));
  EXPECT_TRUE(comes([this] { return unclutches == 1; }));
}

/// While the panel is busy: the force is released and the clutch is pressed. They are not one key that is both.
TEST_F(SessionOfAStylus, ForceThatIsReleasedBeforeTheClutchStaysOff) {
  ASSERT_TRUE(is_connected());
  ASSERT_TRUE(is_felt());
  for (const std::uint32_t buttons : {4U, 0U, 1U}) {
    hold_down(buttons);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // no poll comes in between
  }
  EXPECT_TRUE(comes([this] { return session.is_clutched(); }));
  ASSERT_TRUE(holds_down(0));
  EXPECT_TRUE(comes([this] { return unclutches == 1; }));
  session.unclutch(last().workspace.rotation);
  polls(10);
  EXPECT_FALSE(session.is_clutched());
  EXPECT_FALSE(last().feels);
}

TEST_F(SessionOfAStylus, ItsOrientationIsInThePatient) {
  ASSERT_TRUE(is_connected());
  ASSERT_TRUE(comes([this] { return last().orientation.has_value(); }));
  // A quarter turn about the service's z, which points up: about the device's y.
  const glm::dquat turned = glm::angleAxis(glm::half_pi<double>(), glm::dvec3(0, 1, 0));
  const glm::dquat expected = glm::quat_cast(last().workspace.rotation) * turned;
  EXPECT_NEAR(std::abs(glm::dot(*last().orientation, expected)), 1, 1e-6);
  session.disconnect_stylus();
  connect_simulated();
  EXPECT_FALSE(last().orientation) << "the simulated one has none";
}

TEST_F(SessionOfAStylus, ALostOneIsSaidToBeLostAndIsOpenedAgainWithoutAForce) {
  ASSERT_TRUE(is_connected());
  ASSERT_TRUE(is_felt());
  EXPECT_TRUE(session.last_fault().isEmpty());
  server->drop();
  ASSERT_TRUE(comes([this] { return state_line_of(last()).lost; }));
  const StateLine line = state_line_of(last());
  EXPECT_EQ(line.state, SessionState::stopped);
  EXPECT_FALSE(last().trouble.isEmpty());
  EXPECT_THAT(line.words.toStdString(), ::testing::EndsWith(last().trouble.toStdString()));
  EXPECT_FALSE(last().feels);
  ASSERT_TRUE(comes([this] { return !session.last_fault().isEmpty(); }));
  EXPECT_THAT(session.last_fault().toStdString(), ::testing::HasSubstr("device lost"));
  session.feel();
  polls(3);
  EXPECT_EQ(last().force_n, 0) << "a fault stays until it is cleared";
  session.clear_fault();
  EXPECT_TRUE(session.live().is_connected());
  ASSERT_TRUE(comes([this] { return state_line_of(last()).state == SessionState::ready; }));
  EXPECT_FALSE(last().feels) << "only a press turns it on";
  EXPECT_TRUE(is_felt());
}

/// What happens at rest latches nothing, and is told all the same; one press opens the stylus again.
TEST_F(SessionOfAStylus, OneThatIsLostAtRestIsSaidToBeLostAndIsOpenedAgain) {
  ASSERT_TRUE(is_connected());
  for (const bool clutched : {false, true}) {
    ASSERT_TRUE(comes([this] { return state_line_of(last()).state == SessionState::ready && last().force_n == 0; }));
    if (clutched) session.clutch();
    polls(3);  // its zero is taken
    server->drop();
    ASSERT_TRUE(comes([this] { return state_line_of(last()).state == SessionState::stopped; }));
    const StateLine line = state_line_of(last());
    EXPECT_TRUE(line.lost);
    EXPECT_FALSE(line.fault_latched);
    EXPECT_FALSE(last().may_push);
    EXPECT_FALSE(last().trouble.isEmpty());
    EXPECT_EQ(line.words.toStdString(), "Stopped: " + last().trouble.toStdString());
    const int sessions = server->sessions();
    session.clear_fault();
    EXPECT_TRUE(session.live().is_connected());
    EXPECT_TRUE(comes([this] { return state_line_of(last()).state == SessionState::ready; }));
    EXPECT_GT(server->sessions(), sessions);
    EXPECT_FALSE(last().feels);
  }
}

/// Nobody knows the force of a stylus that was lost while it pushed: no zero is told, and that it may push is.
TEST_F(SessionOfAStylus, OneThatIsLostWhileItPushesMayPushOn) {
  ASSERT_TRUE(is_pushed());
  EXPECT_FALSE(last().may_push);
  server->drop();
  ASSERT_TRUE(comes([this] { return state_line_of(last()).lost && last().may_push; }));
  polls(20);
  EXPECT_TRUE(last().may_push) << "as long as nobody has seen a zero taken";
  EXPECT_EQ(glm::length(vector_of(last().tick.sent_n)), 0) << "the session asks for none";
  EXPECT_THAT(state_line_of(last()).words.toStdString(), ::testing::StartsWith("Stopped: the stylus may still push"));
  session.clear_fault();
  ASSERT_TRUE(comes([this] { return state_line_of(last()).state == SessionState::ready; }));
  EXPECT_FALSE(last().may_push);
}

/// The service applies no force: for 0.2 s the driver asks it for 0.2 N at most, and tells so.
TEST_F(SessionOfAStylus, AForceOnTrialIsToldAsItIs) {
  bool was_on_trial = false;
  const auto seen = QObject::connect(&session, &SessionController::polled, [&](const SessionStatus& look) {
    if (!look.feels || !look.is_held_back || !(glm::length(vector_of(look.tick.sent_n)) > 0.25)) return;
    was_on_trial = was_on_trial || std::abs(look.force_n - 0.2) < 1e-9;
    EXPECT_LT(look.peak_n, look.force_n + 1e-9) << "the strip shows the same";
    EXPECT_EQ(state_line_of(look).words.toStdString(), "Feeling: forces are coming up");
  });
  for (int n = 0; n < 5 && !was_on_trial; ++n) {  // on a busy machine no poll may come in these 0.2 s
    ASSERT_TRUE(is_pushed());
    server->with([](device::FakeHaply& service) { service.heeds = false; });
    EXPECT_TRUE(comes([this] { return state_line_of(last()).lost; }));
    server->with([](device::FakeHaply& service) { service.heeds = true; });
    session.disconnect_stylus();
  }
  QObject::disconnect(seen);
  EXPECT_TRUE(was_on_trial);
}

TEST_F(SessionOfAStylus, OneThatIsGoneIsNotOpenedAgainAndItIsSaidWhy) {
  ASSERT_TRUE(is_connected());
  ASSERT_TRUE(is_felt());
  server.reset();
  ASSERT_TRUE(comes([this] { return state_line_of(last()).lost; }));
  told.clear();
  session.clear_fault();
  EXPECT_FALSE(session.live().is_connected());
  EXPECT_FALSE(last().connected);
  ASSERT_FALSE(told.empty());
  EXPECT_TRUE(told.back().second);
  EXPECT_THAT(told.back().first, ::testing::HasSubstr("127.0.0.1"));
}

/// Another fault than a lost stylus is forgotten, and the same session goes on.
TEST_F(SessionOfAStylus, AFaultOfTheHandIsClearedWithoutOpeningTheStylusAgain) {
  ASSERT_TRUE(is_connected());
  ASSERT_TRUE(is_felt());
  bool is_far = false;
  ASSERT_TRUE(comes([&] {  // to and fro, faster than any hand
    is_far = !is_far;
    server->with([is_far](device::FakeHaply& service) { service.place = {is_far ? 0.05 : -0.05, 0, 0}; });
    return state_line_of(last()).fault_latched;
  }));
  EXPECT_FALSE(state_line_of(last()).lost);
  const int sessions = server->sessions();
  session.clear_fault();
  EXPECT_TRUE(comes([this] { return state_line_of(last()).state == SessionState::ready; }));
  EXPECT_EQ(server->sessions(), sessions);
  EXPECT_FALSE(last().feels);
}

}  // namespace
}  // namespace palpate::plugin
