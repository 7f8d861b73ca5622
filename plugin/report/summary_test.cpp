/// The numbers and words of a session's summary, compared with a recording in which all numbers are different.

#include "plugin/report/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "modes/testing/test_rig.h"
#include "plugin/session/session.h"
#include "solver/analytical.h"
#include "solver/descent.h"
#include "solver/exact.h"
#include "testdata/analytic.h"

namespace palpate::plugin {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double stiffness = 500;  // N/m: residuals in N and in m differ by this

modes::Scene scene_of_two() {
  modes::Mode skin = modes::testing::surface(modes::TransferFunction(1.0));
  skin.name = "skin";
  modes::Mode grip;
  grip.type = "friction";
  grip.strength_n = modes::TransferFunction(0.1);
  modes::Mode bone = modes::testing::surface(modes::TransferFunction(2.0));
  modes::Scene scene = modes::testing::scene_of({skin, grip, bone});
  scene.name = "two";
  scene.stiffness_n_per_m = stiffness;
  return scene;
}

modes::Plan plan_of(const modes::Scene& scene) {
  modes::Workspace workspace;
  workspace.center_mm = {-10, 20, 30};
  return modes::make_plan(scene, io::FieldSet::value | io::FieldSet::gradient, workspace);
}

/// A tick every millisecond, each with two shares: of the surface given and of friction.
class Made {
 public:
  TickRecord& add(std::uint32_t surface, double surface_n) {
    TickRecord tick;
    tick.index = recording.ticks.size();
    tick.time_s = 2 + 1e-3 * static_cast<double>(tick.index);
    tick.share_count = 2;
    tick.solver = solver::number_of(&solver::analytical_solver);
    recording.shares.push_back({.tick = tick.index, .mode = surface, .force_n = {0, surface_n, 0}});
    recording.shares.push_back({.tick = tick.index, .mode = 1, .force_n = {7, 0, 0}});
    recording.ticks.push_back(tick);
    return recording.ticks.back();
  }
  Summary summary() const { return summarize(recording, plan_of(scene_of_two())); }
  std::string text() const { return to_text(summary(), scene_of_two(), "a scan", "a stylus"); }
  nlohmann::json json() const { return nlohmann::json::parse(to_json(summary(), scene_of_two())); }

  Recording recording;
};

TEST(Summary, LargestsAreOfTheirOwnQuantityAndUnit) {
  Made made;
  for (int n = 0; n < 20; ++n) made.add(0, 0);
  made.recording.ticks[3].sent_n[0] = 3;  // 5 N together
  made.recording.ticks[3].sent_n[2] = -4;
  made.recording.ticks[4].force_n[1] = 9;
  made.recording.ticks[5].residual_n = 2e-9;
  made.recording.ticks[6].error_bound_m = 7e-13;
  const Summary summary = made.summary();
  EXPECT_EQ(summary.ticks, 20U);
  EXPECT_NEAR(summary.duration_s, 0.019, 1e-12);
  EXPECT_DOUBLE_EQ(summary.peak_sent_n, 5);
  EXPECT_DOUBLE_EQ(summary.largest_residual_m, 2e-9 / stiffness);
  EXPECT_DOUBLE_EQ(summary.largest_error_bound_m, 7e-13);
  EXPECT_THAT(
      made.text(),
      AllOf(HasSubstr("largest force sent to the device: 5.00 N"),
            HasSubstr("certified error of the proxy at most 7.0e-13 m; residual / k at most 4.0e-12 m"),
            HasSubstr("Palpate session: 0.0 s, 20 ticks"), HasSubstr("scan      a scan"), HasSubstr("scene     two"),
            HasSubstr("device    a stylus"), HasSubstr("nothing: no boundary pushed"), HasSubstr("no fault")));
  EXPECT_EQ(made.json()["peak_sent_n"], 5);
  EXPECT_DOUBLE_EQ(made.json()["largest_residual_m"], 2e-9 / stiffness);
  EXPECT_DOUBLE_EQ(made.json()["largest_error_bound_m"], 7e-13);
  EXPECT_NEAR(made.json()["duration_s"], 0.019, 1e-12);
  EXPECT_EQ(made.json()["frames"], 20);
}

TEST(Summary, MissedTicksAreNotLostTicks) {
  Made made;
  for (int n = 0; n < 5; ++n) made.add(0, 0).missed = n == 2 ? 3 : n == 4 ? 8 : 0;
  made.recording.gaps = {{.first_tick = 2, .ticks = 40}, {.first_tick = 90, .ticks = 2}};
  EXPECT_EQ(made.summary().missed, 11U);
  EXPECT_EQ(made.summary().lost, 42U);
  EXPECT_THAT(made.text(), HasSubstr("Missed ticks     11; ticks lost to the recording 42\n"));
  EXPECT_EQ(made.json()["missed_ticks"], 11);
  EXPECT_EQ(made.json()["lost_frames"], 42);
}

TEST(Summary, SolversAndOutcomesAreCountedApart) {
  Made made;
  const auto add = [&](int count, const solver::SolverType* type, solver::Outcome outcome) {
    for (int n = 0; n < count; ++n) {
      TickRecord& tick = made.add(0, 0);
      tick.solver = solver::number_of(type);
      tick.outcome = static_cast<std::uint32_t>(outcome);
    }
  };
  add(1, &solver::analytical_solver, solver::Outcome::solved);
  add(2, &solver::exact_solver, solver::Outcome::solved);
  add(4, &solver::descent_solver, solver::Outcome::capped);
  add(8, nullptr, solver::Outcome::refused);
  add(16, nullptr, solver::Outcome::unsuitable);
  EXPECT_THAT(made.text(), HasSubstr("analytical 1 ticks, exact 2, descent 4; work cap hit 4, refused 24\n"));
  EXPECT_EQ(made.json()["solver_frames"],
            nlohmann::json({{"analytical", 1}, {"exact", 2}, {"descent", 4}, {"capped", 4}, {"refused", 24}}));
}

TEST(Summary, PercentilesAreTheOrderedValues) {
  std::vector<double> values;
  for (int n = 1000; n >= 0; --n) values.push_back(n);
  const Percentiles all = percentiles_of(values);
  EXPECT_EQ(all.median, 500);
  EXPECT_EQ(all.p99, 990);
  EXPECT_EQ(all.p999, 999);
  EXPECT_EQ(all.largest, 1000);
  EXPECT_EQ(percentiles_of({}).largest, 0);

  Made made;
  for (std::uint32_t n = 0; n <= 1000; ++n) {
    TickRecord& tick = made.add(0, 0);
    for (std::size_t stage = 0; stage < stage_count; ++stage) tick.stage_ns[stage] = 1000 * n;
  }
  EXPECT_THAT(made.text(),
              HasSubstr("Time of a tick   median 4000.00 us, 99 % 7920.00 us, 99.9 % 7992.00 us, largest 8000.0 us\n"));
  EXPECT_EQ(made.json()["tick_us"],
            nlohmann::json({{"median", 4000.0}, {"p99", 7920.0}, {"p999", 7992.0}, {"largest", 8000.0}}));
}

/// A hold is of the surface that pushes most, from its first tick to its last; friction is none, however hard.
TEST(Summary, HoldsAreOfTheSurfaceThatPushes) {
  Made made;
  for (int n = 0; n < 300; ++n) {
    // In the air; on the skin from 0.1 s to 0.149 s with a gap of 20 ms; on the bone from 0.2 s to 0.249 s.
    const bool skin = n >= 100 && n < 150 && (n < 120 || n >= 140);
    const bool bone = n >= 200 && n < 250;
    TickRecord& tick = made.add(bone ? 2 : 0, skin || bone ? 0.3 : 0.04);
    tick.value = n;
    tick.proxy_m[0] = 1e-3 * n;
    tick.force_n[1] = n == 110 ? 1.25 : n == 220 ? 2.5 : n == 180 ? 9 : 0.5;
  }
  const Summary summary = made.summary();
  ASSERT_EQ(summary.holds.size(), 2U);
  EXPECT_EQ(summary.holds[0].mode, 0U);
  EXPECT_NEAR(summary.holds[0].begin_s, 2.100, 1e-9);
  EXPECT_NEAR(summary.holds[0].end_s, 2.149, 1e-9);
  EXPECT_EQ(summary.holds[0].value, 100);
  EXPECT_EQ(summary.holds[0].peak_n, 1.25);
  // The device's x is the patient's; the workspace lies at (-10, 20, 30) mm.
  EXPECT_NEAR(summary.holds[0].contact_mm.x, 90, 1e-9);
  EXPECT_NEAR(summary.holds[0].contact_mm.y, 20, 1e-9);
  EXPECT_NEAR(summary.holds[0].contact_mm.z, 30, 1e-9);
  EXPECT_EQ(summary.holds[1].mode, 2U);
  EXPECT_NEAR(summary.holds[1].begin_s, 2.200, 1e-9);
  EXPECT_EQ(summary.holds[1].peak_n, 2.5);
  EXPECT_THAT(
      made.text(),
      AllOf(HasSubstr("   2.100 to  2.149 s  skin         met at L 90.0 P 20.0 H 30.0 mm, value 100; up to 1.25 N\n"),
            HasSubstr("   2.200 to  2.249 s  surface      met at L 190.0 P 20.0 H 30.0 mm, value 200; up to 2.50 N\n"),
            Not(HasSubstr("nothing:"))));
  const nlohmann::json holds = made.json()["holds"];
  ASSERT_EQ(holds.size(), 2U);
  EXPECT_EQ(holds[0]["boundary"], "skin");
  EXPECT_EQ(holds[1]["boundary"], "surface");
  EXPECT_EQ(holds[1]["value"], 200);
  EXPECT_EQ(holds[1]["peak_n"], 2.5);
  EXPECT_NEAR(holds[1]["contact_mm"][0], 190, 1e-9);
}

/// LPS: x grows towards the patient's left, y towards the back (posterior), z towards the head (DICOM PS3.3
/// C.7.6.2.1.1).
TEST(Summary, SidesOfThePatient) {
  EXPECT_EQ(patient_coordinates({12.34, 4, 88.06}), "L 12.3 P 4.0 H 88.1 mm");
  EXPECT_EQ(patient_coordinates({-12.34, 4, 88.06}), "R 12.3 P 4.0 H 88.1 mm");
  EXPECT_EQ(patient_coordinates({12.34, -4, 88.06}), "L 12.3 A 4.0 H 88.1 mm");
  EXPECT_EQ(patient_coordinates({12.34, 4, -88.06}), "L 12.3 P 4.0 F 88.1 mm");
}

/// The nearest that a stroke came to each structure is its largest distance, which is positive inside; each at its own
/// time, under its own name, in the order of the ticks.
TEST(Summary, EachStructureIsApproachedMostAtItsOwnTime) {
  Made made;
  for (int n = 0; n < 30; ++n) {
    TickRecord& tick = made.add(0, 0);
    tick.distance_mm[0] = -2.5 - std::abs(n - 12);  // nearest at 12 ms: 2.5 mm away
    tick.distance_mm[1] = 1.5 - std::abs(n - 21);   // deepest at 21 ms: 1.5 mm inside
    tick.distance_mm[2] = 99;                       // of no structure
  }
  modes::Scene scene = scene_of_two();
  scene.structures = {{.name = "aorta"}, {.name = "not read"}, {.name = "liver"}};
  modes::Plan plan = plan_of(scene_of_two());
  plan.structures = {2, 0};
  const Summary summary = summarize(made.recording, plan);
  EXPECT_THAT(to_text(summary, scene, "", ""),
              HasSubstr("How near it came to structures\n  2.5 mm from liver, at 2.012 s\n"
                        "  1.5 mm inside aorta, at 2.021 s\n\n"));
  const nlohmann::json told = nlohmann::json::parse(to_json(summary, scene))["structures"];
  EXPECT_EQ(told.size(), 2U);
  EXPECT_EQ(told["liver"]["largest_distance_mm"], -2.5);
  EXPECT_NEAR(told["liver"]["time_s"], 2.012, 1e-9);
  EXPECT_EQ(told["aorta"]["largest_distance_mm"], 1.5);
  EXPECT_NEAR(told["aorta"]["time_s"], 2.021, 1e-9);
}

TEST(Summary, EachFaultIsToldOnceWithItsTimeAndAdvice) {
  Made made;
  for (int n = 0; n < 100; ++n) {
    const auto fault = n < 20   ? device::Fault::none
                       : n < 40 ? device::Fault::device_lost
                       : n < 60 ? device::Fault::none
                                : device::Fault::speed_exceeded;
    made.add(0, 0).safety = pack_safety(device::State::fault, fault);
  }
  const Summary summary = made.summary();
  EXPECT_THAT(summary.faults, ElementsAre(StartsWith("at 2.020 s: device lost (The stylus is gone"),
                                          StartsWith("at 2.060 s: speed exceeded (The stylus moved faster")));
  EXPECT_THAT(made.text(), AllOf(HasSubstr("  " + summary.faults[0] + "\n"), HasSubstr("  " + summary.faults[1] + "\n"),
                                 Not(HasSubstr("no fault"))));
  EXPECT_EQ(made.json()["faults"].size(), 2U);
}

/// Contact chatters at its edge: what is interrupted for less than 50 ms is one hold.
TEST(Summary, AnInterruptionOfFiftyMillisecondsEndsAHold) {
  for (const int interrupted : {48, 51}) {
    Made made;
    for (int n = 0; n < 200; ++n) made.add(0, n < 100 || n >= 100 + interrupted ? 0.3 : 0.01);
    EXPECT_EQ(made.summary().holds.size(), interrupted < 50 ? 1U : 2U) << interrupted;
  }
}

/// How well a boundary is known, which frames were felt, and what put a structure there: in words and as JSON.
TEST(Summary, FramesRegistrationsAndWhatIsKnownAreToldUnderTheirNames) {
  Summary summary;
  summary.holds = {{.mode = 0, .begin_s = 1, .end_s = 2.5, .peak_n = 0.5, .known_to_mm = 0.25}, {.mode = 2}};
  summary.scan_frames = {{3, 17}, {5, 17}};
  summary.approaches = {{.structure = 0, .distance_mm = -1, .time_s = 4}};
  io::RigidMotion motion;
  motion.shift = {1, -2, 30};
  summary.registered = {{"aorta", "00000000000000ab", motion}};
  modes::Scene scene = scene_of_two();
  scene.structures = {{.name = "aorta"}};
  EXPECT_THAT(to_text(summary, scene, "", ""),
              AllOf(HasSubstr("\nframe     3 of 0 to 16\nframe     5 of 0 to 16\n"),
                    HasSubstr("up to 0.50 N; known to +-0.25 mm\n"), HasSubstr("up to 0.00 N\n"),
                    HasSubstr("  aorta was moved by 1.0, -2.0, 30.0 mm: the registration 00000000000000ab\n")));
  const nlohmann::json told = nlohmann::json::parse(to_json(summary, scene));
  EXPECT_EQ(told["scan_frames"], nlohmann::json({3, 5}));
  EXPECT_EQ(told["holds"][0]["known_to_mm"], 0.25);
  EXPECT_EQ(told["holds"][0]["begin_s"], 1);
  EXPECT_EQ(told["holds"][0]["end_s"], 2.5);
  EXPECT_FALSE(told["holds"][1].contains("known_to_mm"));
  EXPECT_EQ(told["structures"]["aorta"]["registration"], "00000000000000ab");
  EXPECT_EQ(told["structures"]["aorta"]["registered_by"], "1.0, -2.0, 30.0 mm");
  summary.scan_frames = {{0, 1}};
  EXPECT_THAT(to_text(summary, scene, "", ""), Not(HasSubstr("frame "))) << "a scan with one frame";
}

/// A fault is reported where it begins, also in the first tick, whichever it is.
TEST(Summary, AFaultOfTheFirstTickIsSaid) {
  for (int n = 1; n <= static_cast<int>(device::Fault::commander_silent); ++n) {
    const auto fault = static_cast<device::Fault>(n);
    Made made;
    for (int tick = 0; tick < 3; ++tick) made.add(0, 0).safety = pack_safety(device::State::fault, fault);
    const std::string wanted = std::string("at 2.000 s: ") + device::name_of(fault) + " (";
    EXPECT_THAT(made.summary().faults, ElementsAre(StartsWith(wanted)));
  }
}

/// A solver that this program does not know is counted as none, and as nothing else.
TEST(Summary, TicksOfAnUnknownSolverAreCountedNowhere) {
  Made made;
  for (int n = 0; n < 3; ++n) made.add(0, 0);
  const Summary known = made.summary();
  for (const std::uint32_t number : {64U, 65U, 66U, 1000U}) made.add(0, 0).solver = number;
  const Summary both = made.summary();
  EXPECT_EQ(both.ticks, 7U);
  EXPECT_EQ(both.solver_ticks, known.solver_ticks);
  EXPECT_EQ(both.capped, 0U);
  EXPECT_EQ(both.refused, 0U);
}

}  // namespace
}  // namespace palpate::plugin
