#pragma once

/// A controller with a ball of soft tissue of radius 25 mm at the origin, and what it emits.

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/openigtlink/testing/shared_session.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/model/testing/application.h"
#include "plugin/paraview/client/model/testing/made_text.h"
#include "plugin/testing/test_clocks.h"

namespace palpate::plugin::testing {

struct ControlledSession : WithApplication, ::testing::Test {
  ControlledSession() {
    session.set_clock([](double period_s) { return std::make_unique<UnhurriedClock>(period_s); });
    model.open(modes::load_scene("ct-skin-and-bone"));
    session.set_scan(igtl::testing::ball_of_tissue(), {});
    QObject::connect(&session, &SessionController::told, [this](const QString& text, bool problem) {
      if (!text.isEmpty()) told.emplace_back(text.toStdString(), problem);
    });
    QObject::connect(&session, &SessionController::marked, [this](const MarkMade& made) { marks.push_back(made); });
    QObject::connect(&session, &SessionController::clutch_button_let_go, [this] { ++unclutches; });
  }
  ~ControlledSession() override { session.disconnect_stylus(); }

  void connect_simulated() {
    session.connect_stylus({.device = "simulated"});
    ASSERT_TRUE(comes([this] { return session.last().fresh; }));
  }
  const SessionStatus& last() const { return session.last(); }
  bool is_near(const glm::dvec3& place_mm) const { return glm::distance(last().probe_mm, place_mm) < 1; }
  /// Waits until the simulated hand has reached the place; if a force acts, it stops a little before it.
  bool goes_to(const glm::dvec3& place_mm) {
    session.move_hand(place_mm);
    return comes([&] { return is_near(place_mm); });
  }
  /// Lets the panel poll some times.
  void polls(int times) {
    int left = times;
    const auto counted = QObject::connect(&session, &SessionController::polled, [&left] { --left; });
    EXPECT_TRUE(comes([&] { return left <= 0; }));
    QObject::disconnect(counted);
  }
  bool pushes() {
    return comes([this] { return last().force_n > 0.1; });
  }

  MadeText kept;
  SceneModel model{kept};
  SessionController session{model};
  std::vector<std::pair<std::string, bool>> told;
  std::vector<MarkMade> marks;
  int unclutches = 0;
  const glm::dvec3 outside{0, -32, 0}, inside{0, -24, 0};  // mm
};

}  // namespace palpate::plugin::testing
