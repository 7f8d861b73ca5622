#include "plugin/session/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <vector>

#include "device/simulated/replay_stylus.h"
#include "device/simulated/simulated_stylus.h"
#include "modes/scene/scene_json.h"
#include "solver/analytical.h"
#include "solver/exact.h"
#include "testdata/analytic.h"
#include "testdata/flow.h"

namespace palpate::plugin {
namespace {

using testdata::AnalyticSource;

/// A slab of soft tissue below z = 0 of the patient, bone from 10 mm on; the patient's head end is up.
std::shared_ptr<const AnalyticSource> plain_slab() {
  const std::vector<testdata::Layer> layers{{.depth = 0, .value = testdata::soft_tissue_hu},
                                            {.depth = 10, .value = testdata::bone_hu}};
  return std::make_shared<AnalyticSource>(testdata::make_slab({0, 0, -1}, layers), 1.5);
}

std::shared_ptr<const modes::Plan> plan_of(const char* scene) {
  return std::make_shared<const modes::Plan>(
      modes::make_plan(modes::load_scene(scene), io::FieldSet::value | io::FieldSet::gradient, modes::Workspace{}));
}

/// Down on to the skin, through it to the bone, and up again.
const std::vector<device::Waypoint> press_way{
    {.time = 0, .position = {0, 0.02, 0}},   {.time = 1, .position = {0, 0.02, 0}},
    {.time = 2, .position = {0, -0.003, 0}}, {.time = 2.5, .position = {0, -0.003, 0}},
    {.time = 4, .position = {0, -0.018, 0}}, {.time = 4.5, .position = {0, -0.018, 0}},
    {.time = 5.5, .position = {0, 0.02, 0}}, {.time = 6, .position = {0, 0.02, 0}}};

std::vector<TickRecord> run(device::Stylus& stylus, std::size_t count) {
  Session session(plan_of("ct-skin-and-bone"), plain_slab(), stylus,
                  limits_for(modes::Limits{}, stylus.specification()));
  std::vector<TickRecord> ticks;
  for (std::size_t n = 0; n < count; ++n) {
    ticks.push_back(session.tick());
  }
  return ticks;
}

std::vector<TickRecord> press_once(std::uint64_t seed) {
  device::SimulatedDevice model;
  model.hand.tremor_seed = seed;
  device::SimulatedStylus stylus(model);
  stylus.follow(press_way);
  return run(stylus, 6000);
}

bool same(const std::vector<TickRecord>& a, const std::vector<TickRecord>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_in_replay);
}

TEST(Session, SkinThenBoneThenNothing) {
  const std::vector<TickRecord> ticks = press_once(1);
  const auto force_at = [&](double time) { return ticks[static_cast<std::size_t>(time * 1000)].sent_n[1]; };
  EXPECT_EQ(force_at(0.5), 0) << "nothing is felt in the air";
  EXPECT_GT(force_at(2.4), 0.3) << "the skin pushes up";
  EXPECT_LT(force_at(2.4), 1.2);
  EXPECT_GT(force_at(4.4), 1.2) << "the bone pushes harder than the skin ever does";
  EXPECT_EQ(force_at(5.9), 0) << "lifted off";
  for (const TickRecord& tick : ticks) {
    EXPECT_LE(glm::length(glm::dvec3(tick.sent_n[0], tick.sent_n[1], tick.sent_n[2])), 3.0 + 1e-12);
    EXPECT_EQ(static_cast<solver::Outcome>(tick.outcome), solver::Outcome::solved);
    EXPECT_LT(tick.error_bound_m, 1e-12);
  }
}

/// What a tick's record says, against what was there: the stylus' pose, the scan at the proxy, the coupling's law and
/// the balance of the shares.
TEST(Session, EveryNumberOfItsRecordIsWhatItIsCalled) {
  device::SimulatedStylus stylus;
  stylus.follow(press_way);
  const auto plan = plan_of("ct-skin-and-bone");
  const auto source = plain_slab();
  Session session(plan, source, stylus, limits_for(modes::Limits{}, stylus.specification()));
  const auto vector = [](const double(&v)[3]) { return glm::dvec3(v[0], v[1], v[2]); };
  int held = 0;
  double before = 0;
  for (std::uint64_t n = 0; n < 4600; ++n) {
    const glm::dvec3 grip = stylus.read().position;  // reading twice in a tick gives the same pose
    const double time = 1e-3 * static_cast<double>(n) + 7;
    const TickRecord record = session.tick({.time_s = time,
                                            .heartbeat_s = time - 0.25,
                                            .missed = static_cast<std::uint32_t>(n % 5),
                                            .late_ns = static_cast<std::uint32_t>(100 + n % 7)});
    ASSERT_EQ(record.index, n);
    ASSERT_EQ(record.time_s, time);
    ASSERT_NEAR(record.dt_s, time - before, 1e-12);
    before = time;
    ASSERT_EQ(record.heartbeat_s, time - 0.25);
    ASSERT_NEAR(record.pose_time_s, 1e-3 * static_cast<double>(n), 1e-9) << "on the device's own clock";
    ASSERT_EQ(record.missed, n % 5);
    ASSERT_EQ(record.late_ns, 100 + n % 7);
    ASSERT_EQ(vector(record.probe_m), grip);
    const glm::dvec3 coupling = plan->stiffness_n_per_m * (vector(record.proxy_m) - vector(record.probe_m));
    ASSERT_LT(glm::length(vector(record.force_n) - coupling), 1e-12);
    const glm::dvec3 proxy_mm = plan->workspace.to_patient(vector(record.proxy_m));
    ASSERT_EQ(record.value, source->sample(proxy_mm, io::FieldSet::value).value);
    ASSERT_EQ(record.share_count, session.shares().size());
    glm::dvec3 balance = -vector(record.force_n);
    for (const PrimitiveRecord& share : session.shares()) {
      balance += vector(share.force_n);
      ASSERT_EQ(share.tick, n);
      ASSERT_LE(glm::length(vector(share.force_n)), share.strength_n * (1 + 1e-12));
    }
    ASSERT_NEAR(record.residual_n, glm::length(balance), 1e-15);
    ASSERT_EQ(record.change_part, 1);
    ASSERT_EQ(record.scene_epoch, 0U);
    held += glm::length(coupling) > 0.3 ? 1 : 0;
  }
  EXPECT_GT(held, 1000);
}

TEST(Session, SameSeedSameBits) {
  EXPECT_TRUE(same(press_once(5), press_once(5)));
  EXPECT_FALSE(same(press_once(5), press_once(6)));
}

TEST(Session, ReplayedPosesGiveTheSameForces) {
  const std::vector<TickRecord> recorded = press_once(3);
  std::vector<device::Reading> readings;
  for (const TickRecord& tick : recorded) {
    readings.push_back(
        {.time = tick.time_s, .position = {tick.probe_m[0], tick.probe_m[1], tick.probe_m[2]}, .fresh = true});
  }
  device::ReplayStylus stylus(readings, device::SimulatedStylus().specification());
  EXPECT_TRUE(same(recorded, run(stylus, recorded.size())));
}

/// Section 5 of the paper: follow and force on the flow stay analytical; with a surface on the pressure the general
/// solver takes over where they are oblique, and the ticks show which.
TEST(Session, TheWindTunnelsTicksShowTheSolver) {
  const auto flow = std::make_shared<testdata::FlowSource>(testdata::FlowPastSphere{});
  const auto solvers_of = [&](const modes::Scene& scene) {
    modes::Workspace workspace;
    workspace.center_mm = {0, -26, 0};  // beside the sphere of 20 mm
    const auto plan = std::make_shared<const modes::Plan>(modes::make_plan(scene, flow->available(), workspace));
    device::SimulatedStylus stylus;
    stylus.follow(std::vector<device::Waypoint>{{.time = 0, .position = {-0.03, 0.004, 0}},
                                                {.time = 2, .position = {0.03, 0.002, 0.004}},
                                                {.time = 4, .position = {-0.03, -0.004, 0.006}}});
    Session session(plan, flow, stylus, limits_for(scene.limits, stylus.specification()));
    std::array<int, 4> count{};
    for (int n = 0; n < 4000; ++n) {
      const TickRecord& tick = session.tick();
      // Solved, or the best answer at the cap on work: either way certified, to less than the device's position step.
      EXPECT_LT(tick.error_bound_m, 0.02e-3) << n;
      ++count[tick.solver];
    }
    return count;
  };
  const auto analytical = solver::number_of(&solver::analytical_solver);
  const auto exact = solver::number_of(&solver::exact_solver);
  modes::Scene scene = modes::load_scene("flow");
  EXPECT_EQ(solvers_of(scene)[analytical], 4000);
  const modes::Scene with_surface = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "side": "both",
          "strength_n": {"of": "gradient_per_mm", "nodes": [[0, 0], [0.02, 1]]}}]})",
      "surface");
  scene.modes.push_back(with_surface.modes.front());
  const auto count = solvers_of(scene);
  EXPECT_GT(count[exact], 0);
  EXPECT_EQ(count[analytical] + count[exact], 4000);
}

TEST(Session, APoseThatIsNotANumberLetsGo) {
  device::SimulatedStylus stylus;
  stylus.follow(press_way);
  Session session(plan_of("ct-skin-and-bone"), plain_slab(), stylus,
                  limits_for(modes::Limits{}, stylus.specification()));
  for (int n = 0; n < 2400; ++n) {
    session.tick();
  }
  EXPECT_GT(session.tick().sent_n[1], 0.3);
  stylus.inject(device::SimulatedFault::not_a_number);
  const TickRecord& tick = session.tick();
  EXPECT_EQ(glm::length(glm::dvec3(tick.sent_n[0], tick.sent_n[1], tick.sent_n[2])), 0);
  EXPECT_NE(session.fault(), device::Fault::none);
  stylus.inject(device::SimulatedFault::none);
  EXPECT_EQ(session.tick().sent_n[1], 0) << "latched: only the user clears it";
}

TEST(Session, ClosesTheStylusWithoutForce) {
  device::SimulatedStylus stylus;
  stylus.follow(press_way);
  { run(stylus, 2400); }
  EXPECT_EQ(stylus.state(), device::State::disconnected);
}

}  // namespace
}  // namespace palpate::plugin
