/// Every number of a tick's record against the same tick computed beside the session: fields, step, damping and filter
/// one after another, on a source and with a stylus that change all that a record can tell.

#include "plugin/session/tick_record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <vector>

#include "device/safety/energy.h"
#include "modes/tick/haptic_step.h"
#include "plugin/testing/session_rig.h"
#include "solver/chain.h"

namespace palpate::plugin {
namespace {

constexpr double end_mm = 10;

/// The slab, with what it lacks: structures, bricks in every other millimeter, and an end.
class Told final : public io::FieldSource {
 public:
  io::FieldSet available() const noexcept override { return slab_->available() | io::FieldSet::distance; }
  io::Sample sample(const io::Vec3& position_mm, io::FieldSet wanted) const noexcept override {
    if (position_mm.z > end_mm) return {};
    io::Sample sample = slab_->sample(position_mm, wanted);
    sample.from_brick = std::lround(position_mm.z) % 2 == 0;
    for (std::size_t n = 0; n < 3; ++n) {
      sample.distance[n] = {.mm = static_cast<double>(n + 1) * position_mm.z + position_mm.x, .gradient = {}};
    }
    return sample;
  }

 private:
  std::shared_ptr<const io::FieldSource> slab_ = testing::slab();
};

/// Dives to and fro through skin and bone, jumps aside now and then, and counts through its buttons and states.
class Diver final : public device::Stylus {
 public:
  device::Specification specification() const override { return {.maximum_force = 3, .stiffness_limit = 1e9}; }
  void open() override {}
  void close() noexcept override {}
  device::Reading read() noexcept override {
    if (reads++ > 0) ++tick;
    const double time = 1e-3 * tick;
    return {.time = time + 5,
            .position = {1e-3 * std::sin(9 * time) + (tick / 700 % 2 == 0 ? 0 : 3e-3),
                         -0.004 - 0.016 * std::cos(3 * time), 1e-3 * std::cos(7 * time)},
            .buttons = static_cast<std::uint32_t>(tick % 3) << 1U,
            .fresh = tick % 10 != 0};
  }
  void write_force(const device::Vec3& force) noexcept override { written_n = force; }
  device::State state() const noexcept override {
    constexpr device::State states[] = {device::State::idle, device::State::ramping, device::State::active};
    return states[tick / 500 % 3];
  }

  int reads = 0, tick = 0;
  device::Vec3 written_n{0};
};

TEST(TickRecord, SaysWhatTheStepTheFilterAndTheStylusDid) {
  const auto source = std::make_shared<const Told>();
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  scene.limits.speed_m_per_s = 10;
  modes::Plan plan = modes::make_plan(scene, source->available(), {});
  plan.structures = {0, 1, 2};
  const auto diver = std::make_shared<Diver>();
  const device::SafetyLimits limits = limits_for(scene.limits, diver->specification());
  Session session({.plan = std::make_shared<const modes::Plan>(plan), .source = source, .limits = limits}, diver);
  session.press(8);

  Diver beside;
  solver::Chain chain({.solvers = plan.solvers});
  const auto scratch = std::make_unique<modes::StepScratch>();
  modes::Touch touch;
  device::EnergyState energy;
  device::SafetyState safety;
  device::arm(safety);
  std::map<const char*, int> times;  // that a record told something else than what it begins with
  for (int n = 0; n < 5000; ++n) {
    const double time = 1e-3 * n;
    const TickRecord& record = session.tick({.time_s = time, .heartbeat_s = time});
    const device::Reading reading = beside.read();
    const modes::StepResult step = modes::step(plan, *source, reading.position, touch, chain, *scratch);
    const device::Vec3 damped = device::damp_ringing({}, reading, step.force_n, energy);
    const device::SafetyResult safe = device::filter_force(limits,
                                                           {.time = time,
                                                            .reading = reading,
                                                            .device = beside.state(),
                                                            .force = damped,
                                                            .force_time = time,
                                                            .heartbeat_time = time},
                                                           safety);
    ASSERT_EQ(vector_of(record.proxy_m), step.proxy_m) << n;
    ASSERT_EQ(vector_of(record.force_n), step.force_n) << n;
    ASSERT_EQ(vector_of(record.sent_n), safe.force) << n;
    ASSERT_EQ(diver->written_n, safe.force);
    ASSERT_EQ(record.pose_time_s, reading.time);
    ASSERT_EQ(record.error_bound_m, step.error_bound);
    ASSERT_EQ(record.sub_steps, static_cast<std::uint32_t>(step.sub_steps));
    ASSERT_EQ(record.halts, static_cast<std::uint32_t>(step.halts));
    ASSERT_EQ(record.iterations, static_cast<std::uint32_t>(step.iterations));
    ASSERT_EQ(record.solver, solver::number_of(step.solver));
    ASSERT_EQ(record.outcome, static_cast<std::uint32_t>(step.outcome));
    ASSERT_EQ(record.from_brick, step.sample.from_brick ? 1U : 0U);
    ASSERT_EQ(record.buttons, reading.buttons | 8U);
    ASSERT_EQ(record.fresh, reading.fresh ? 1U : 0U);
    ASSERT_EQ(static_cast<device::State>(record.stylus_state), beside.state());
    ASSERT_EQ(state_of(record), safe.state);
    ASSERT_EQ(fault_of(record), safe.fault);
    ASSERT_EQ(record.commands, n == 0 ? command::arm : 0U);
    ASSERT_EQ(record.share_count, step.primitives.size());
    for (std::size_t of = 0; of < step.primitives.size(); ++of) {
      const PrimitiveRecord& share = session.shares()[of];
      ASSERT_EQ(share.tick, record.index);
      ASSERT_EQ(share.mode, step.mode_of[of]);
      ASSERT_EQ(share.type, static_cast<std::uint32_t>(step.primitives[of].type));
      ASSERT_EQ(share.strength_n, step.primitives[of].strength);
      ASSERT_EQ(vector_of(share.force_n), step.shares[of]);
    }
    const glm::dvec3 place_mm = plan.workspace.to_patient(step.proxy_m);
    const bool inside = place_mm.z <= end_mm;
    ASSERT_EQ(std::isnan(record.value), !inside);
    for (std::size_t of = 0; of < distance_count; ++of) {
      if (of >= 3) {
        ASSERT_TRUE(std::isnan(record.distance_mm[of]));
      } else if (inside) {
        ASSERT_NEAR(record.distance_mm[of], static_cast<double>(of + 1) * place_mm.z + place_mm.x, 1e-12);
      }
    }
    times["outside"] += inside ? 0 : 1;
    times["sub-steps"] += record.sub_steps > 1 ? 1 : 0;
    times["halts"] += record.halts > 0 ? 1 : 0;
    times["bricks"] += record.from_brick > 0 ? 1 : 0;
    times["none of them"] += record.from_brick == 0 ? 1 : 0;
    times["pushes"] += glm::length(safe.force) > 0.1 ? 1 : 0;
  }
  for (const auto& [what, often] : times) EXPECT_GT(often, 0) << what;
}

/// While a scene comes in that moves the reach, as recordings of version 0.1.0 have it, the proxy is where the reach is
/// on its way; its value is of the scan that comes in.
TEST(TickRecord, WhileTheReachMovesItsValueIsOfWhereTheProxyIs) {
  const auto left = testing::slab(), coming = testing::slab(3);
  const modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  modes::Workspace from, to;
  from.center_mm = {0, 0, -1};
  to.center_mm = {2, 3, -9};
  to.mm_per_m = 1600;
  const auto snapshot = [&](const auto& source, const modes::Workspace& reach) {
    return Snapshot{.plan = std::make_shared<const modes::Plan>(modes::make_plan(scene, source->available(), reach)),
                    .source = source,
                    .limits = limits_for(scene.limits, device::SimulatedStylus().specification()),
                    .change_s = 0.2,
                    .is_replayed = true};
  };
  Session session(snapshot(left, from), testing::stylus(testing::hold()));
  for (int n = 0; n < 800; ++n) session.tick();
  session.publish(snapshot(coming, to));
  int on_the_way = 0;
  for (int n = 0; n < 250; ++n) {
    const TickRecord& record = session.tick();
    const modes::Workspace reach = modes::between(from, to, record.change_part);
    const glm::dvec3 proxy_mm = reach.to_patient(vector_of(record.proxy_m));
    ASSERT_NEAR(record.value, coming->sample(proxy_mm, io::FieldSet::value).value, 1e-6) << n;
    on_the_way += record.change_part > 0.05 && record.change_part < 0.95 ? 1 : 0;
  }
  EXPECT_GT(on_the_way, 150);
}

}  // namespace
}  // namespace palpate::plugin
