#include "plugin/report/compare_strokes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>

#include "device/simulated/simulated_stylus.h"
#include "modes/scene/scene_json.h"
#include "plugin/app/run_session.h"
#include "plugin/session/scan_hash.h"
#include "plugin/testing/test_files.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using namespace ::testing;
using plugin::testing::fresh_path;

std::shared_ptr<const io::Volume> ball(double radius_mm) {
  return std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(radius_mm), testdata::make_geometry({.size = glm::ivec3(60)})));
}

struct Press {
  double strength_n = 1;
  double slower = 1;    ///< times as long
  double rest_s = 0.5;  ///< pressed
  double aside_m = 0;   ///< to the right, in the hand
};

/// Down on to the top of the ball and up again.
Recording record(const std::shared_ptr<const io::Volume>& volume, const Press& press) {
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  for (modes::Mode& mode : scene.modes) mode.strength_n = modes::TransferFunction(press.strength_n);
  const auto stylus = std::make_shared<device::SimulatedStylus>();
  const double s = press.slower, x = press.aside_m;
  stylus->follow(std::vector<device::Waypoint>{{.time = 0, .position = {x, 0.034, 0}},
                                               {.time = 0.5 * s, .position = {x, 0.034, 0}},
                                               {.time = 1.5 * s, .position = {x, 0.022, 0}},
                                               {.time = 1.5 * s + press.rest_s, .position = {x, 0.022, 0}},
                                               {.time = 2.5 * s + press.rest_s, .position = {x, 0.034, 0}}});
  const device::Specification specification = stylus->specification();
  const auto file = fresh_path("press.h5");
  run_session({.scene = scene,
               .felt = prepare(scene, volume, specification.workspace_half_extent),
               .scan_hash = hash_of(*volume),
               .unit = volume->unit,
               .stylus = stylus,
               .seconds = 2.5 * s + press.rest_s,
               .at_clock_pace = false},
              file);
  return read_recording(file);
}

double largest(const std::vector<double>& of) {
  return *std::max_element(of.begin(), of.end());
}

TEST(RecordedSession, IsWhereTheHandWasInThePatient) {
  const auto volume = ball(25);
  const Recording recording = record(volume, {});
  const RecordedSession session(recording, *volume);
  ASSERT_EQ(session.size(), recording.ticks.size());
  EXPECT_NEAR(session.duration_s(), 3, 0.01);
  const SceneRecord& record = recording.scenes.front();
  const modes::Workspace workspace =
      plan_for(modes::scene_from_json(record.scene, "test"), *volume, record.half_extent_m)->workspace;
  std::size_t shares = 0;
  for (std::size_t n = 0; n < session.size(); ++n) {
    const auto& probe = recording.ticks[n].probe_m;
    ASSERT_EQ(session.probe_mm(n), workspace.to_patient({probe[0], probe[1], probe[2]}));
    for (const PrimitiveRecord& share : session.shares(n)) ASSERT_EQ(share.tick, session.tick(n).index);
    shares += session.shares(n).size();
    ASSERT_EQ(session.tick_at(session.time_s(n)), n);
  }
  EXPECT_EQ(shares, recording.shares.size());
  EXPECT_GT(shares, 0U);
  EXPECT_EQ(session.tick_at(-1), 0U);
  EXPECT_EQ(session.tick_at(1e9), session.size() - 1);
}

TEST(RecordedSession, IsOfTheScanThatWasFelt) {
  EXPECT_THAT([] { RecordedSession(record(ball(25), {}), *ball(20)); },
              ThrowsMessage<std::runtime_error>(HasSubstr("another scan")));
  const auto volume = ball(25);
  Recording recording = record(volume, {});
  // As if the second half had felt another scan.
  SceneRecord other = recording.scenes.front();
  other.epoch = 1;
  other.scan_hash = "0123456789abcdef";
  recording.scenes.push_back(other);
  const std::size_t half = recording.ticks.size() / 2;
  for (std::size_t n = half; n < recording.ticks.size(); ++n) recording.ticks[n].scene_epoch = 1;
  const RecordedSession session(recording, *volume);
  EXPECT_EQ(session.size(), half);
  EXPECT_EQ(session.elsewhere(), recording.ticks.size() - half);
  recording.ticks.clear();
  recording.shares.clear();
  EXPECT_THAT([&] { RecordedSession(recording, *volume); }, ThrowsMessage<std::runtime_error>(HasSubstr("empty")));
}

TEST(RecordedSession, GoesFromOneWorkspaceToTheNextAsTheSessionDid) {
  const auto volume = ball(25);
  Recording recording = record(volume, {});
  SceneRecord moved = recording.scenes.front();
  moved.epoch = 4;
  modes::Scene scene = modes::scene_from_json(moved.scene, "test");
  scene.workspace = {.center_mm = glm::dvec3(0, 10, 0), .fit = false};
  moved.scene = modes::to_json(scene);
  recording.scenes.push_back(moved);
  const std::size_t half = recording.ticks.size() / 2;
  for (std::size_t n = half; n < recording.ticks.size(); ++n) {
    recording.ticks[n].scene_epoch = 4;
    recording.ticks[n].change_part = n == half ? 0.25 : 1;
  }
  const RecordedSession session(recording, *volume);
  const glm::dvec3 before = session.workspace(0).center_mm, after = session.workspace(half + 1).center_mm;
  EXPECT_NEAR(after.y, 10, 1e-9);
  EXPECT_NEAR(glm::distance(session.workspace(half).center_mm, glm::mix(before, after, 0.25)), 0, 1e-9);
}

/// What is sent is the coupling's pull from the probe to the proxy, in the patient as in the hand, in any direction.
TEST(RecordedSession, ForcesPointFromTheProbeToTheProxyInThePatient) {
  const auto volume = ball(25);
  const RecordedSession session(record(volume, {.aside_m = 0.008}), *volume);
  int compared = 0;
  for (std::size_t n = 0; n < session.size(); ++n) {
    const TickRecord& tick = session.tick(n);
    const bool is_whole = glm::distance(vector_of(tick.sent_n), vector_of(tick.force_n)) == 0;
    if (!is_whole || glm::length(vector_of(tick.sent_n)) < 0.1) continue;
    const glm::dvec3 pull_mm = session.proxy_mm(n) - session.probe_mm(n);
    const double stiffness_n_per_mm = session.scene(n).stiffness_n_per_m / session.workspace(n).mm_per_m;
    ASSERT_LT(glm::distance(session.sent_n(n), stiffness_n_per_mm * pull_mm), 1e-9) << n;
    ++compared;
  }
  EXPECT_GT(compared, 300);
}

TEST(CompareStrokes, ARecordingIsTheSameAsItself) {
  const auto volume = ball(25);
  const RecordedSession session(record(volume, {}), *volume);
  const Comparison same = compare_strokes(session, session);
  EXPECT_EQ(same.most_apart_mm, 0);
  EXPECT_EQ(same.largest_difference_n, 0);
  EXPECT_EQ(same.first_n, same.second_n);
  EXPECT_GT(largest(same.first_n), 0.3) << "something was felt";
  EXPECT_GT(same.along_mm.back(), 10) << "down and up";
}

/// A damaged recording: nothing is read outside of the coupled steps (seen by the sanitizers), and the comparison ends.
TEST(CompareStrokes, PlacesThatAreNoNumbersEndIt) {
  const auto volume = ball(25);
  const Recording pressed = record(volume, {});
  for (const double odd : {std::numeric_limits<double>::quiet_NaN(), 1e200, -std::numeric_limits<double>::infinity()}) {
    for (const bool first : {true, false}) {
      Recording damaged = pressed;
      damaged.ticks[first ? 0 : damaged.ticks.size() / 2].probe_m[1] = odd;
      const RecordedSession whole(pressed, *volume), broken(damaged, *volume);
      EXPECT_FALSE(compare_strokes(broken, whole).along_mm.empty());
      EXPECT_FALSE(compare_strokes(whole, broken).along_mm.empty());
    }
  }
}

TEST(CompareStrokes, SpeedDoesNotCount) {
  const auto volume = ball(25);
  const RecordedSession once(record(volume, {}), *volume), slowly(record(volume, {.slower = 3}), *volume);
  const Comparison comparison = compare_strokes(once, slowly);
  // The simulated hand is a spring: it lags by what its speed and the force ask of it.
  EXPECT_LT(comparison.most_apart_mm, 2);
  EXPECT_LT(comparison.mean_difference_n, 0.15 * largest(comparison.first_n));
}

TEST(CompareStrokes, RestDoesNotCount) {
  const auto volume = ball(25);
  const RecordedSession once(record(volume, {}), *volume), resting(record(volume, {.rest_s = 10}), *volume);
  const double way_mm = compare_strokes(once, once).along_mm.back();
  const Comparison comparison = compare_strokes(resting, once);
  EXPECT_NEAR(comparison.along_mm.back(), way_mm, 0.1 * way_mm) << "ten seconds of tremor make no way";
  double deepest_mm = 0;
  for (std::size_t n = 0; n < once.size(); ++n) {
    deepest_mm = std::max(deepest_mm, glm::distance(once.probe_mm(n), once.probe_mm(0)));
  }
  EXPECT_NEAR(way_mm, 2 * deepest_mm, 0.15 * way_mm) << "down and up";
  EXPECT_LT(comparison.mean_difference_n, 0.1 * largest(comparison.first_n));
}

TEST(CompareStrokes, AStrongerBoundaryShowsWhereItIs) {
  const auto volume = ball(25);
  const RecordedSession soft(record(volume, {.strength_n = 0.4}), *volume),
      firm(record(volume, {.strength_n = 1.2}), *volume);
  const Comparison comparison = compare_strokes(soft, firm);
  EXPECT_GT(comparison.largest_difference_n, 0.4);
  const auto at = static_cast<std::size_t>(
      std::lower_bound(comparison.along_mm.begin(), comparison.along_mm.end(), comparison.largest_difference_at_mm) -
      comparison.along_mm.begin());
  EXPECT_NEAR(std::abs(comparison.second_n[at] - comparison.first_n[at]), comparison.largest_difference_n, 1e-12);
  for (std::size_t n = 1; n < comparison.along_mm.size(); ++n)
    ASSERT_GT(comparison.along_mm[n], comparison.along_mm[n - 1]);
}

/// Also of ways of different lengths: the mean is that of the rows, and they are the first recording's steps.
TEST(CompareStrokes, TheMeanDifferenceIsThatOfTheRows) {
  const auto volume = ball(25);
  Recording half = record(volume, {.strength_n = 0.4});
  half.ticks.resize(half.ticks.size() / 3);
  const RecordedSession part(half, *volume), whole(record(volume, {.strength_n = 1.2}), *volume);
  for (const bool swapped : {false, true}) {
    const Comparison comparison = swapped ? compare_strokes(whole, part) : compare_strokes(part, whole);
    const double most = comparison.largest_difference_n;
    double sum = 0;
    for (std::size_t n = 0; n < comparison.first_n.size(); ++n) {
      sum += std::abs(comparison.second_n[n] - comparison.first_n[n]);
    }
    EXPECT_NEAR(comparison.mean_difference_n, sum / static_cast<double>(comparison.along_mm.size()), 1e-9);
    EXPECT_GT(comparison.mean_difference_n, 0);
    EXPECT_LT(comparison.mean_difference_n, most);
  }
}

TEST(CompareStrokes, TellsWhereTheWaysAreNotTheSame) {
  const auto volume = ball(25);
  const RecordedSession here(record(volume, {}), *volume), aside(record(volume, {.aside_m = 0.01}), *volume);
  const double mm_per_m = here.workspace(0).mm_per_m;
  const double apart = compare_strokes(here, aside).most_apart_mm;
  EXPECT_GT(apart, 0.9 * 0.01 * mm_per_m);
  EXPECT_LT(apart, 1.6 * 0.01 * mm_per_m);
}

/// A stroke in a recording's own workspace: its ticks are at these heights, mm along the patient's y.
Recording along_y(const Recording& like, const std::vector<double>& places_mm) {
  const modes::Workspace workspace =
      plan_for(modes::scene_from_json(like.scenes.front().scene, "test"), *ball(25), like.scenes.front().half_extent_m)
          ->workspace;
  Recording made = like;
  made.ticks.resize(places_mm.size());
  for (std::size_t n = 0; n < places_mm.size(); ++n) {
    const glm::dvec3 at = workspace.to_device({0, places_mm[n], 0});
    for (int axis = 0; axis < 3; ++axis) made.ticks[n].probe_m[axis] = at[axis];
  }
  return made;
}

/// A hand that goes back on the way and comes again: only there are the two apart, by no more than it went back.
TEST(CompareStrokes, ADetourIsApartWhereItIsAndNowhereElse) {
  const auto volume = ball(25);
  const Recording pressed = record(volume, {});
  std::vector<double> straight, detour;
  const auto go = [](std::vector<double>& places, double from, double to) {
    for (int n = 0; n <= 100; ++n) places.push_back(from + (to - from) * n / 100);
  };
  go(straight, -28, 12);
  go(detour, -28, -8);
  go(detour, -8, -14);
  go(detour, -14, 12);
  const RecordedSession one(along_y(pressed, straight), *volume), other(along_y(pressed, detour), *volume);
  for (const bool turned : {false, true}) {
    const Comparison comparison = turned ? compare_strokes(other, one) : compare_strokes(one, other);
    EXPECT_LT(comparison.most_apart_mm, 6);
    EXPECT_GT(comparison.most_apart_mm, 1);
    EXPECT_LT(comparison.apart_mm.front(), 2);
    EXPECT_LT(comparison.apart_mm.back(), 2);
  }
}

TEST(CompareStrokes, IsAPictureATableAndASentence) {
  const auto volume = ball(25);
  const RecordedSession session(record(volume, {}), *volume);
  const Comparison comparison = compare_strokes(session, session);
  EXPECT_EQ(charts_of(comparison, "a", "b").size(), 3U);
  EXPECT_THAT(in_words(comparison), HasSubstr("at most 0.00 N"));
  const auto file = fresh_path("comparison.csv");
  write_csv(comparison, file);
  std::ifstream table(file);
  std::string header;
  std::getline(table, header);
  EXPECT_EQ(header, "along_mm,first_n,second_n,apart_mm");
  EXPECT_EQ(std::count(std::istreambuf_iterator<char>(table), {}, '\n'),
            static_cast<std::ptrdiff_t>(comparison.along_mm.size()));
  EXPECT_THAT([&] { write_csv(comparison, "/nowhere/c.csv"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("/nowhere/c.csv")));
}

}  // namespace
}  // namespace palpate::plugin
