// The transforms of one tick against the formulas of its workspace.

#include "plugin/openigtlink/frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <iterator>
#include <optional>
#include <random>

namespace palpate::plugin::igtl {
namespace {

TickRecord seeded_tick(std::mt19937& seeded, double time_s) {
  std::uniform_real_distribution<double> place(-0.1, 0.1), newton(-3, 3);
  TickRecord tick;
  tick.time_s = time_s;
  for (int axis = 0; axis < 3; ++axis) {
    tick.probe_m[axis] = place(seeded);
    tick.proxy_m[axis] = place(seeded);
    tick.force_n[axis] = newton(seeded);
    tick.sent_n[axis] = newton(seeded);
  }
  return tick;
}

modes::Workspace seeded_workspace(std::mt19937& seeded) {
  std::uniform_real_distribution<double> place(-300, 300), part(-1, 1), scale(200, 3000);
  const glm::dquat turned = glm::normalize(glm::dquat(part(seeded), part(seeded), part(seeded), part(seeded)));
  return {.center_mm = {place(seeded), place(seeded), place(seeded)},
          .rotation = glm::mat3_cast(turned),
          .mm_per_m = scale(seeded)};
}

/// RAS points to the right and to the front, where LPS points to the left and to the back.
glm::dvec3 in_ras(const glm::dvec3& lps) {
  return {-lps.x, -lps.y, lps.z};
}

/// The stylus' own way over its time. Whatever holds the proxy has no part in it.
TEST(OpenIgtFrame, TheVelocityIsThatOfTheStylus) {
  std::mt19937 seeded(7);
  std::uniform_real_distribution<double> time(0.001, 0.02);
  for (int n = 0; n < 60; ++n) {
    const modes::Workspace workspace = seeded_workspace(seeded);
    const double apart_s = time(seeded);
    const TickRecord before = seeded_tick(seeded, 5);
    TickRecord tick = seeded_tick(seeded, 5 + apart_s);
    if (n % 3 == 0) std::copy(std::begin(before.probe_m), std::end(before.probe_m), std::begin(tick.probe_m));
    if (n % 3 == 1) std::copy(std::begin(before.proxy_m), std::end(before.proxy_m), std::begin(tick.proxy_m));
    const glm::dvec3 way_m = vector_of(tick.probe_m) - vector_of(before.probe_m);
    const glm::dvec3 expected = in_ras(workspace.mm_per_m * (workspace.rotation * way_m)) / apart_s;
    const Frame frame = frame_of(tick, before, workspace, std::nullopt);
    EXPECT_LT(glm::distance(frame.velocity.translation, expected), 1e-9 + 1e-9 * glm::length(expected)) << n;
    EXPECT_EQ(frame.velocity.rotation, glm::dmat3(1)) << n;
    for (const auto& earlier : {std::optional<TickRecord>(), std::optional(seeded_tick(seeded, tick.time_s)),
                                std::optional(seeded_tick(seeded, tick.time_s + 1))}) {
      EXPECT_EQ(frame_of(tick, earlier, workspace, std::nullopt).velocity.translation, glm::dvec3(0))
          << n << ": no time has passed";
    }
  }
}

TEST(OpenIgtFrame, PlacesAndForceAreThoseOfTheTick) {
  std::mt19937 seeded(8);
  for (int n = 0; n < 60; ++n) {
    const modes::Workspace workspace = seeded_workspace(seeded);
    const TickRecord tick = seeded_tick(seeded, 5);
    const Frame frame = frame_of(tick, std::nullopt, workspace, std::nullopt);
    const auto place = [&](const glm::dvec3& at_m) {
      return in_ras(workspace.center_mm + workspace.mm_per_m * (workspace.rotation * at_m));
    };
    EXPECT_LT(glm::distance(frame.stylus.translation, place(vector_of(tick.probe_m))), 1e-9) << n;
    EXPECT_LT(glm::distance(frame.proxy.translation, place(vector_of(tick.proxy_m))), 1e-9) << n;
    const glm::dvec3 sent = in_ras(workspace.rotation * vector_of(tick.sent_n));
    EXPECT_LT(glm::distance(frame.force.translation, sent), 1e-12) << n << ": newtons, whatever the scale";
  }
}

}  // namespace
}  // namespace palpate::plugin::igtl
