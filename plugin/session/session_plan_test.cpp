// A session runs exactly its plan: counted of the whole session, with its stylus, what was left out.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <string>
#include <vector>

#include "device/simulated/replay_stylus.h"
#include "plugin/testing/session_rig.h"
#include "solver/analytical.h"
#include "solver/chain.h"
#include "solver/exact.h"

namespace palpate::plugin {
namespace {

using io::FieldSet;
using namespace testing;

/// Counts what is asked of a slab.
class CountedSlab : public io::FieldSource {
 public:
  FieldSet available() const noexcept override { return slab_->available(); }
  io::Sample sample(const io::Vec3& position_mm, FieldSet wanted) const noexcept override {
    ++samples;
    if (samples > 1 && position_mm == place_mm) ++repeats;
    place_mm = position_mm;
    asked = asked | wanted;
    return slab_->sample(position_mm, wanted);
  }
  mutable int samples = 0, repeats = 0;
  mutable io::Vec3 place_mm{0};
  mutable FieldSet asked = FieldSet::none;

 private:
  std::shared_ptr<const io::FieldSource> slab_ = slab();
};

Snapshot of(const char* text, const std::shared_ptr<const io::FieldSource>& source) {
  const modes::Scene scene = modes::scene_from_json(text, "test");
  return {.plan = std::make_shared<const modes::Plan>(modes::make_plan(scene, source->available(), {})),
          .source = source,
          .limits = limits_for(scene.limits, device::SimulatedStylus().specification()),
          .change_s = 0.1};
}

constexpr const char* one_surface = R"({"version": 1, "modes": [{"type": "surface", "strength_n": 1}]})";
constexpr const char* surface_and_landmarks = R"({"version": 1, "modes": [{"type": "surface", "strength_n": 1},
  {"type": "landmark", "shape": "point", "strength_n": 0.1, "position_mm": [0, 0, 5]}]})";

TEST(SessionPlan, SamplesThePlansFieldsAndTheValueOnceAtEachPlace) {
  const auto source = std::make_shared<CountedSlab>();
  const auto held = stylus(press());
  Session session(of(one_surface, source), held);
  int places = 1, moved = 0;  // where the hand is at first
  glm::dvec3 proxy_m(0);
  for (int n = 0; n < 3000; ++n) {
    const TickRecord& tick = session.tick();
    places += static_cast<int>(tick.sub_steps + tick.halts);
    if (vector_of(tick.proxy_m) != proxy_m) ++moved;
    proxy_m = vector_of(tick.proxy_m);
  }
  const modes::Plan plan = *of(one_surface, source).plan;
  EXPECT_EQ(source->asked, plan.fields | FieldSet::value);
  EXPECT_EQ(source->repeats, 0);
  EXPECT_LE(source->samples, places);
  EXPECT_GE(source->samples, moved);
}

TEST(SessionPlan, HoldsNoSolverThatWasLeftOutButWhileAChangeLasts) {
  const std::size_t analytical = solver::Chain({.solvers = {&solver::analytical_solver}}).memory_bytes();
  const std::size_t all = solver::Chain().memory_bytes();
  const auto source = slab();
  const auto held = stylus(hold());
  Session session(of(one_surface, source), held);
  EXPECT_EQ(session.solver_bytes(), analytical) << "no exact solver, and none for a change that may never come";
  const auto run = [&session](int ticks) {
    bool exact = false;
    for (int n = 0; n < ticks; ++n) {
      const std::uint32_t solver = session.tick().solver;
      exact = exact || solver == solver::number_of(&solver::exact_solver);
    }
    session.collect();
    return exact;
  };
  EXPECT_FALSE(run(1000));
  session.publish(of(surface_and_landmarks, source));
  run(50);
  EXPECT_GT(session.solver_bytes(), all + analytical) << "of two scenes together";
  EXPECT_TRUE(run(1000));
  EXPECT_EQ(session.solver_bytes(), all);
  for (int changes = 0; changes < 3; ++changes) {
    session.publish(of(one_surface, source));
    run(1000);
  }
  EXPECT_EQ(session.solver_bytes(), analytical);
  EXPECT_FALSE(run(1000));
}

/// Of this process, as the kernel counts them.
struct Held {
  std::ptrdiff_t threads, files;
  std::string children;
  bool operator==(const Held&) const = default;
};
Held held_now() {
  const auto entries = [](const char* folder) {
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
  };
  std::string children;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream file(task.path() / "children");
    children += std::string(std::istreambuf_iterator<char>(file), {});
  }
  return {entries("/proc/self/task"), entries("/proc/self/fd"), children};
}

TEST(SessionPlan, ASimulatedStylusBringsNoThreadDeviceOrGuardian) {
  const auto source = slab();
  const Held before = held_now();
  const auto held = stylus(press());
  Session session(of(one_surface, source), held);
  for (int n = 0; n < 2500; ++n) session.tick();
  EXPECT_EQ(held_now(), before);
  EXPECT_GT(std::abs(session.tick().sent_n[1]), 0.1) << "nothing was felt";
}

/// A hand that shakes against a surface, as ringing does: damped where there are motors, and nowhere else.
TEST(SessionPlan, AStylusWithoutMotorsIsNotDamped) {
  const auto most_damping_n = [](int force_axes) {
    std::vector<device::Reading> readings;
    for (int n = 0; n < 3000; ++n) {
      const double time = 1e-3 * n;
      readings.push_back({.time = time, .position = {0, -0.001 + 0.0005 * std::sin(600 * time), 0}, .fresh = true});
    }
    device::Specification specification = device::SimulatedStylus().specification();
    specification.force_axes = force_axes;
    Session session(of(one_surface, slab()), std::make_shared<device::ReplayStylus>(readings, specification));
    double most = 0;
    for (int n = 0; n < 3000; ++n) {
      const TickRecord& tick = session.tick();
      if (n > 1000) most = std::max(most, glm::distance(vector_of(tick.sent_n), vector_of(tick.force_n)));
    }
    return most;
  };
  EXPECT_EQ(most_damping_n(0), 0);
  EXPECT_GT(most_damping_n(3), 0.01);
}

}  // namespace
}  // namespace palpate::plugin
