/// A recording in patient space, against an independent calculation: with ticks of another scan in between, different
/// numbers of shares in each tick, and a workspace that is rotated, scaled and moved.

#include "plugin/recording/recorded_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <utility>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/session/scan_hash.h"
#include "testdata/phantom.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

const io::Volume& felt_scan() {
  static const io::Volume volume =
      testdata::scan(testdata::make_sphere(5), testdata::make_geometry({.size = glm::ivec3(16)}));
  return volume;
}

/// Where the hand's reach lies in the patient, by hand: the axes of the device are the columns.
struct Reach {
  glm::dvec3 center_mm{0};
  std::array<glm::dvec3, 3> axes;
  double scale = 1;

  glm::dvec3 direction(const double (&v)[3]) const { return v[0] * axes[0] + v[1] * axes[1] + v[2] * axes[2]; }
  glm::dvec3 place_mm(const double (&at_m)[3]) const { return center_mm + 1000 * scale * direction(at_m); }
};

const Reach first_reach{{10, -20, 30}, {{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}}, 2};
const Reach second_reach{{-5, 7, 11}, {{{0.6, 0.8, 0}, {-0.8, 0.6, 0}, {0, 0, 1}}}, 0.5};

std::string scene_at(const std::string& name, const Reach& reach) {
  modes::Scene scene =
      modes::scene_from_json(R"({"version": 1, "modes": [{"type": "surface", "strength_n": 0.6}]})", "test");
  scene.name = name;
  scene.workspace.center_mm = reach.center_mm;
  scene.workspace.rotation = {reach.axes[0], reach.axes[1], reach.axes[2]};
  scene.workspace.scale = reach.scale;
  return modes::to_json(scene);
}

/// 40 ticks of the scan, 30 of another and 30 of the scan again, every number another.
Recording three_stretches() {
  Recording recording;
  const std::string here = hash_of(felt_scan());
  recording.scenes = {{.epoch = 0, .scene = scene_at("first", first_reach), .scan_hash = here},
                      {.epoch = 1, .scene = scene_at("elsewhere", first_reach), .scan_hash = "another"},
                      {.epoch = 2, .scene = scene_at("second", second_reach), .scan_hash = here}};
  for (std::uint32_t n = 0; n < 100; ++n) {
    TickRecord tick;
    tick.index = 500 + n;
    tick.time_s = 7 + 1e-3 * n;
    tick.scene_epoch = n < 40 ? 0 : n < 70 ? 1 : 2;
    for (int axis = 0; axis < 3; ++axis) {
      tick.probe_m[axis] = 1e-4 * n + 1e-3 * axis;
      tick.proxy_m[axis] = -2e-4 * n + 3e-3 * axis;
      tick.sent_n[axis] = 0.01 * n - 0.5 * axis;
    }
    tick.share_count = (n * 7) % 4;
    for (std::uint32_t share = 0; share < tick.share_count; ++share) {
      recording.shares.push_back({.tick = tick.index, .mode = share, .strength_n = 100.0 * n + share});
    }
    recording.ticks.push_back(tick);
    recording.known_to_mm.push_back(n);
  }
  return recording;
}

std::string refusal_of(Recording recording) {
  try {
    RecordedSession(std::move(recording), felt_scan());
  } catch (const std::exception& refusal) {
    return refusal.what();
  }
  return "none";
}

TEST(RecordedSession, SaysOfAnEmptyRecordingAndOfOneOnAnotherScanWhichItIs) {
  EXPECT_EQ(refusal_of({}), "the recording is empty: no tick of it was written");
  Recording elsewhere = three_stretches();
  elsewhere.header.scan_hash = "that one";
  for (SceneRecord& scene : elsewhere.scenes) scene.scan_hash = "another";
  const std::string said = refusal_of(std::move(elsewhere));
  EXPECT_NE(said.find("that one"), std::string::npos) << said;
  EXPECT_NE(said.find(hash_of(felt_scan())), std::string::npos) << said;
}

TEST(RecordedSession, EachTickOfTheScanHasItsOwnTimeSharesAndPlaceInThePatient) {
  const Recording recording = three_stretches();
  const RecordedSession session(recording, felt_scan());
  ASSERT_EQ(session.size(), 70U);
  EXPECT_EQ(session.elsewhere(), 30U);
  EXPECT_NEAR(session.duration_s(), 0.099, 1e-12);
  for (std::size_t n = 0; n < session.size(); ++n) {
    const std::size_t was = n < 40 ? n : n + 30;
    const TickRecord& tick = recording.ticks[was];
    ASSERT_EQ(session.tick(n).index, tick.index);
    EXPECT_NEAR(session.time_s(n), 1e-3 * static_cast<double>(was), 1e-12);
    ASSERT_EQ(session.shares(n).size(), tick.share_count) << n;
    for (std::size_t share = 0; share < tick.share_count; ++share) {
      EXPECT_EQ(session.shares(n)[share].tick, tick.index);
      EXPECT_EQ(session.shares(n)[share].strength_n, 100.0 * static_cast<double>(was) + static_cast<double>(share));
    }
    const Reach& reach = n < 40 ? first_reach : second_reach;
    EXPECT_EQ(session.scene(n).name, n < 40 ? "first" : "second");
    EXPECT_LT(glm::distance(session.probe_mm(n), reach.place_mm(tick.probe_m)), 1e-9) << n;
    EXPECT_LT(glm::distance(session.proxy_mm(n), reach.place_mm(tick.proxy_m)), 1e-9) << n;
    EXPECT_LT(glm::distance(session.sent_n(n), reach.direction(tick.sent_n)), 1e-12) << "a force is turned, not scaled";
  }
}

/// The last tick that is not later; before the first there is the first.
TEST(RecordedSession, ATickIsFoundByItsTimeAfterTheFirst) {
  const RecordedSession session(three_stretches(), felt_scan());
  for (std::size_t n = 0; n < session.size(); ++n) {
    const double time_s = session.time_s(n);
    EXPECT_EQ(session.tick_at(time_s + 1e-7), n);
    EXPECT_EQ(session.tick_at(time_s + 0.9e-3), n);
    EXPECT_EQ(session.tick_at(time_s - 1e-7), n == 0 ? 0 : n - 1);
  }
  EXPECT_EQ(session.tick_at(0.055), 39U) << "while the other scan was felt";
  EXPECT_EQ(session.tick_at(-1), 0U);
  EXPECT_EQ(session.tick_at(1e9), 69U);
}

/// While a scene comes in, the reach goes from the place of the ticks before to its own, as far as the change has come.
TEST(RecordedSession, AChangeMovesTheReachFromTheOneBefore) {
  Recording recording = three_stretches();
  for (int n = 70; n < 100; ++n) recording.ticks[static_cast<std::size_t>(n)].change_part = (n - 70) / 20.0;
  const RecordedSession session(recording, felt_scan());
  for (std::size_t n = 40; n < 70; ++n) {
    const double part = std::min(1.0, static_cast<double>(n - 40) / 20);
    const modes::Workspace at = session.workspace(n);
    const glm::dvec3 center_mm = first_reach.center_mm + part * (second_reach.center_mm - first_reach.center_mm);
    EXPECT_LT(glm::distance(at.center_mm, center_mm), 1e-9) << n;
    EXPECT_NEAR(at.mm_per_m, 2000 * std::pow(0.25, part), 1e-9) << n;
    const TickRecord& tick = session.tick(n);
    EXPECT_LT(glm::distance(session.probe_mm(n), at.to_patient(vector_of(tick.probe_m))), 1e-9);
    EXPECT_LT(glm::distance(session.sent_n(n), at.rotation * vector_of(tick.sent_n)), 1e-12);
  }
}

/// Each change begins where the scene before it was, however many there were.
TEST(RecordedSession, EveryChangeBeginsAtTheSceneBeforeIt) {
  constexpr std::uint32_t scenes = 6;
  const auto center_of = [](std::uint32_t n) { return glm::dvec3(5.0 * n * n, -3.0 * n, 20.0 - 7.0 * n); };
  Recording recording;
  for (std::uint32_t n = 0; n < scenes; ++n) {
    Reach reach = first_reach;
    reach.center_mm = center_of(n);
    recording.scenes.push_back({.epoch = n, .scene = scene_at("scene", reach), .scan_hash = hash_of(felt_scan())});
    for (const double part : {0.0, 0.25, 1.0}) {
      TickRecord tick;
      tick.index = recording.ticks.size();
      tick.time_s = 1e-3 * static_cast<double>(tick.index);
      tick.scene_epoch = n;
      tick.change_part = part;
      recording.ticks.push_back(tick);
    }
  }
  const RecordedSession session(recording, felt_scan());
  ASSERT_EQ(session.size(), 3 * scenes);
  for (std::size_t n = 0; n < session.size(); ++n) {
    const TickRecord& tick = session.tick(n);
    const std::uint32_t now = tick.scene_epoch;
    const glm::dvec3 before_mm = center_of(now == 0 ? 0 : now - 1);
    const glm::dvec3 wanted_mm = before_mm + tick.change_part * (center_of(now) - before_mm);
    EXPECT_LT(glm::distance(session.workspace(n).center_mm, wanted_mm), 1e-9) << n;
    EXPECT_LT(glm::distance(session.probe_mm(n), wanted_mm), 1e-9) << n;
  }
}

/// Distances are recorded of the structures that a mode of the tick's scene reads, in the order of its modes, and of
/// those with a margin after them.
TEST(RecordedSession, EachTickKnowsTheStructuresOfItsScene) {
  struct Case {
    std::string structures, modes;
    std::vector<std::size_t> measured;
  };
  const std::string of_liver = R"({"type": "surface", "structure": "liver", "strength_n": 1})";
  const std::string of_aorta = R"({"type": "surface", "structure": "aorta", "strength_n": 1})";
  const std::string three = R"({"name": "liver", "file": "a", "segment": 1}, {"name": "unread", "file": "a",
      "segment": 2}, {"name": "aorta", "file": "a", "segment": 3})";
  const std::string with_margin = R"({"name": "near", "file": "a", "segment": 4, "margin_mm": 3}, )" + three;
  const std::vector<Case> cases{{three, of_liver, {0}},
                                {three, of_aorta + "," + of_liver, {2, 0}},
                                {"", R"({"type": "surface", "strength_n": 1})", {}},
                                {with_margin, of_aorta, {3, 0}}};
  Recording recording;
  for (std::uint32_t n = 0; n < cases.size(); ++n) {
    recording.scenes.push_back({.epoch = n,
                                .scene = R"({"version": 1, "structures": [)" + cases[n].structures +
                                         R"(], "modes": [)" + cases[n].modes + "]}",
                                .scan_hash = hash_of(felt_scan()),
                                .half_extent_m = glm::dvec3(0.1)});
    TickRecord tick;
    tick.index = n;
    tick.scene_epoch = n;
    recording.ticks.push_back(tick);
  }
  const RecordedSession session(recording, felt_scan());
  ASSERT_EQ(session.size(), cases.size());
  for (std::size_t n = 0; n < cases.size(); ++n) EXPECT_EQ(session.structures(n), cases[n].measured) << n;
}

}  // namespace
}  // namespace palpate::plugin
