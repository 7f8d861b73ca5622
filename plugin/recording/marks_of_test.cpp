/// The marks of a recording, against an independent analysis of presses: random paths of the proxy, random buttons,
/// shares of two scenes, and measures computed only from the positions.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/recording/marks.h"
#include "plugin/recording/recorded_session.h"
#include "plugin/session/scan_hash.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

const io::Volume& marked_scan() {
  static const io::Volume volume =
      testdata::scan(testdata::make_sphere(5), testdata::make_geometry({.size = glm::ivec3(16)}));
  return volume;
}

/// In the patient a millimeter of hand is two, along other axes.
std::string marked_scene() {
  modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "name": "skin", "strength_n": 0.6}, {"type": "friction", "strength_n": 0.1}]})",
      "test");
  scene.workspace.center_mm = glm::dvec3(3, -4, 5);
  scene.workspace.rotation = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  scene.workspace.scale = 2;
  return modes::to_json(scene);
}

glm::dvec3 place_of(const TickRecord& tick) {  // x to the patient's y, y to z, z to x
  return glm::dvec3(3, -4, 5) + 2000.0 * glm::dvec3(tick.proxy_m[2], tick.proxy_m[0], tick.proxy_m[1]);
}

Recording random_presses(std::mt19937& random, int ticks) {
  std::normal_distribution<double> normal;
  Recording recording;
  recording.scenes = {{.epoch = 3, .scene = marked_scene(), .scan_hash = hash_of(marked_scan())}};
  glm::dvec3 proxy_m(0);
  bool down = random() % 2 == 0, moves = false;
  for (int n = 0; n < ticks; ++n) {
    if (random() % 25 == 0) {
      down = !down;
      moves = random() % 2 == 0;
    }
    proxy_m += (moves ? 2e-4 : 4e-5) * glm::dvec3(normal(random), normal(random), normal(random));
    TickRecord tick;
    tick.index = 100 + static_cast<std::uint64_t>(n);
    tick.time_s = 4 + 2e-2 * n;
    tick.scene_epoch = 3;
    tick.value = normal(random);
    tick.buttons = (down ? mark_button : 0) | (random() % 2 == 0 ? 5 : 0);  // others mark nothing
    for (int axis = 0; axis < 3; ++axis) {
      tick.proxy_m[axis] = proxy_m[axis];
      tick.probe_m[axis] = 7;
      tick.sent_n[axis] = normal(random);
    }
    tick.share_count = static_cast<std::uint32_t>(random() % 4);
    for (std::uint32_t share = 0; share < tick.share_count; ++share) {
      PrimitiveRecord one{.tick = tick.index, .mode = static_cast<std::uint32_t>(random() % 2)};
      if (random() % 3 == 0) one.mode += 0x80;  // of a scene that is being left
      for (double& newtons : one.force_n) newtons = random() % 6 == 0 ? 0 : normal(random);
      recording.shares.push_back(one);
    }
    recording.ticks.push_back(tick);
  }
  return recording;
}

Marks marks_by_hand(const Recording& recording) {
  Marks marks;
  std::size_t share = 0;
  std::vector<std::size_t> first_share;
  for (const TickRecord& tick : recording.ticks) {
    first_share.push_back(share);
    share += tick.share_count;
  }
  const std::size_t size = recording.ticks.size();
  const auto is_held = [&](std::size_t tick) {
    for (std::size_t n = 0; n < recording.ticks[tick].share_count; ++n) {
      const PrimitiveRecord& one = recording.shares[first_share[tick] + n];
      if (one.mode == 0 && std::hypot(one.force_n[0], one.force_n[1], one.force_n[2]) > 0.05) return true;
    }
    return false;
  };
  for (std::size_t begin = 0; begin < size; ++begin) {
    if ((recording.ticks[begin].buttons & 2) == 0) continue;
    std::size_t end = begin;
    while (end < size && (recording.ticks[end].buttons & 2) != 0) ++end;
    const TickRecord& first = recording.ticks[begin];
    const auto since = [&](const TickRecord& tick) { return tick.time_s - recording.ticks[0].time_s; };
    MarkedPath path{.begin_s = since(first), .end_s = since(recording.ticks[end - 1]), .points_mm = {place_of(first)}};
    bool moved = false;
    for (std::size_t n = begin; n < end; ++n) {
      const glm::dvec3 at = place_of(recording.ticks[n]);
      moved = moved || glm::distance(at, place_of(first)) > 2;
      if (glm::distance(at, path.points_mm.back()) >= 0.2 || (n + 1 == end && at != path.points_mm.back())) {
        path.length_mm += glm::distance(at, path.points_mm.back());
        if (is_held(n)) path.touched_mm += glm::distance(at, path.points_mm.back());
        path.points_mm.push_back(at);
      }
    }
    if (moved && path.end_s - path.begin_s >= 0.25) {
      path.name = "Path " + std::to_string(marks.paths.size() + 1);
      marks.paths.push_back(path);
    } else {
      double strongest = 0.05;
      std::string boundary;
      for (std::size_t n = 0; n < first.share_count; ++n) {
        const PrimitiveRecord& one = recording.shares[first_share[begin] + n];
        const double length = std::hypot(one.force_n[0], one.force_n[1], one.force_n[2]);
        if (one.mode != 0 || length <= strongest) continue;  // friction is no boundary
        strongest = length;
        boundary = "skin";
      }
      marks.points.push_back({.name = "Mark " + std::to_string(marks.points.size() + 1),
                              .tick = first.index,
                              .time_s = since(first),
                              .position_mm = place_of(first),
                              .boundary = boundary,
                              .value = first.value,
                              .force_n = std::hypot(first.sent_n[0], first.sent_n[1], first.sent_n[2])});
    }
    begin = end;
  }
  return marks;
}

/// Degrees between two ways, from their cross product too: exact also where they are nearly alike or opposite.
double between(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 / M_PI;
}

TEST(MarksOf, ARecordingAreItsPresses) {
  std::mt19937 random(11);
  int points = 0, paths = 0, at_ends = 0;
  for (int n = 0; n < 40; ++n) {
    const Recording recording = random_presses(random, 60 + 20 * (n % 10));
    at_ends += (recording.ticks.front().buttons & 2) + (recording.ticks.back().buttons & 2) == 4 ? 1 : 0;
    const Marks marks = marks_of(RecordedSession(recording, marked_scan()));
    const Marks wanted = marks_by_hand(recording);
    ASSERT_EQ(marks.points.size(), wanted.points.size());
    for (std::size_t of = 0; of < wanted.points.size(); ++of) {
      const FeltMark &one = marks.points[of], &other = wanted.points[of];
      EXPECT_EQ(one.name, other.name);
      EXPECT_EQ(one.tick, other.tick);
      EXPECT_NEAR(one.time_s, other.time_s, 1e-12);
      EXPECT_LT(glm::distance(one.position_mm, other.position_mm), 1e-9);
      EXPECT_EQ(one.boundary, other.boundary);
      EXPECT_EQ(one.value, other.value);
      EXPECT_NEAR(one.force_n, other.force_n, 1e-12);
    }
    ASSERT_EQ(marks.paths.size(), wanted.paths.size());
    for (std::size_t of = 0; of < wanted.paths.size(); ++of) {
      const MarkedPath &one = marks.paths[of], &other = wanted.paths[of];
      EXPECT_EQ(one.name, other.name);
      EXPECT_NEAR(one.begin_s, other.begin_s, 1e-12);
      EXPECT_NEAR(one.end_s, other.end_s, 1e-12);
      EXPECT_NEAR(one.length_mm, other.length_mm, 1e-9);
      EXPECT_NEAR(one.touched_mm, other.touched_mm, 1e-9);
      ASSERT_EQ(one.points_mm.size(), other.points_mm.size());
      for (std::size_t p = 0; p < one.points_mm.size(); ++p) {
        EXPECT_LT(glm::distance(one.points_mm[p], other.points_mm[p]), 1e-9);
      }
    }
    const auto at = [&](std::size_t of) { return marks.points[of].position_mm; };
    ASSERT_EQ(marks.distances.size(), std::max<std::size_t>(marks.points.size(), 1) - 1);
    for (std::size_t of = 0; of < marks.distances.size(); ++of) {
      EXPECT_EQ(marks.distances[of].from, of);
      EXPECT_EQ(marks.distances[of].to, of + 1);
      EXPECT_NEAR(marks.distances[of].mm, glm::length(at(of) - at(of + 1)), 1e-9);
    }
    ASSERT_EQ(marks.angles.size(), std::max<std::size_t>(marks.points.size(), 2) - 2);
    for (std::size_t of = 0; of < marks.angles.size(); ++of) {
      EXPECT_EQ(marks.angles[of].from, of);
      EXPECT_EQ(marks.angles[of].at, of + 1);
      EXPECT_EQ(marks.angles[of].to, of + 2);
      EXPECT_NEAR(marks.angles[of].degrees, between(at(of) - at(of + 1), at(of + 2) - at(of + 1)), 1e-5);
    }
    points += static_cast<int>(marks.points.size());
    paths += static_cast<int>(marks.paths.size());
  }
  EXPECT_GT(points, 40);
  EXPECT_GT(paths, 20);
  EXPECT_GT(at_ends, 0) << "pressed from the first tick to the last";
}

/// The angle between any two ways; none if one of them has no length. Along one line it is 0 or 180, whatever
/// rounding makes of its cosine.
TEST(MarksOf, AnglesAreThoseBetweenTheirWays) {
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  const auto any = [&] { return glm::dvec3(10 * normal(random), normal(random), 0.1 * normal(random)); };
  for (int n = 0; n < 300; ++n) {
    Marks marks;
    marks.points.resize(3);
    for (FeltMark& mark : marks.points) mark.position_mm = any();
    const auto at = [&](std::size_t of) { return marks.points[of].position_mm; };
    EXPECT_NEAR(angle_degrees(marks, 0, 2, 1).value(), between(at(0) - at(2), at(1) - at(2)), 1e-5);
    EXPECT_NEAR(distance_mm(marks, 2, 0), glm::length(at(0) - at(2)), 1e-12);
    const glm::dvec3 way = any();
    marks.points[0].position_mm = marks.points[2].position_mm + way;
    marks.points[1].position_mm = marks.points[2].position_mm + 3.7 * way;
    EXPECT_NEAR(angle_degrees(marks, 0, 2, 1).value(), 0, 1e-5);
    marks.points[1].position_mm = marks.points[2].position_mm - 0.3 * way;
    EXPECT_NEAR(angle_degrees(marks, 0, 2, 1).value(), 180, 1e-5);
    marks.points[n % 2 == 0 ? 0 : 1].position_mm = marks.points[2].position_mm;
    EXPECT_FALSE(angle_degrees(marks, 0, 2, 1));
    EXPECT_TRUE(angle_degrees(marks, 0, 1, 2).has_value() || n % 2 == 1);
  }
}

/// Whichever mark is removed, what lay between the others lies between the same ones.
TEST(MarksOf, RemovingOneLeavesWhatIsBetweenTheOthers) {
  std::mt19937 random(13);
  for (int n = 0; n < 200; ++n) {
    Marks marks;
    for (int of = 0; of < 6; ++of) marks.points.push_back({.name = std::string(1, static_cast<char>('a' + of))});
    const auto any = [&] { return random() % marks.points.size(); };
    for (int of = 0; of < 8; ++of) marks.distances.push_back({.from = any(), .to = any()});
    for (int of = 0; of < 8; ++of) marks.angles.push_back({.from = any(), .at = any(), .to = any()});
    const auto named = [&](const Marks& all) {
      std::vector<std::string> names;
      for (const MarkedDistance& of : all.distances) names.push_back(all.points[of.from].name + all.points[of.to].name);
      for (const MarkedAngle& of : all.angles) {
        names.push_back(all.points[of.from].name + all.points[of.at].name + all.points[of.to].name);
      }
      return names;
    };
    std::vector<std::string> wanted = named(marks);
    const std::size_t removed = any();
    const std::string gone = marks.points[removed].name;
    std::erase_if(wanted, [&](const std::string& one) { return one.find(gone) != std::string::npos; });
    remove_mark(marks, removed);
    ASSERT_EQ(marks.points.size(), 5U);
    for (const FeltMark& mark : marks.points) EXPECT_NE(mark.name, gone);
    EXPECT_EQ(named(marks), wanted);
  }
}

/// The lowest number that no other has, each kind by itself.
TEST(MarksOf, ANewNameHasTheLowestFreeNumber) {
  std::mt19937 random(14);
  for (int n = 0; n < 50; ++n) {
    Marks marks;
    std::set<int> of_marks, of_paths;
    for (int one = 1; one < 8; ++one) {
      if (random() % 4 != 0) of_marks.insert(one);
      if (random() % 4 != 0) of_paths.insert(one);
    }
    for (const int one : of_marks) marks.points.insert(marks.points.begin(), {.name = "Mark " + std::to_string(one)});
    for (const int one : of_paths) marks.paths.insert(marks.paths.begin(), {.name = "Path " + std::to_string(one)});
    const auto lowest = [](const std::set<int>& taken) {
      int free = 1;
      while (taken.count(free) > 0) ++free;
      return std::to_string(free);
    };
    EXPECT_EQ(free_mark_name(marks), "Mark " + lowest(of_marks));
    EXPECT_EQ(free_path_name(marks), "Path " + lowest(of_paths));
  }
}

}  // namespace
}  // namespace palpate::plugin
