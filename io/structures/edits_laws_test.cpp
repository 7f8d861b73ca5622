// The laws of edits.h, over seeded bodies: round, oblique, uneven, thin and merged.
#include "io/structures/edits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <vector>

#include "io/structures/edit_changes.h"
#include "io/structures/outline_places.h"
#include "io/testing/made_labels.h"
#include "solver/text/message.h"
#include "solver/text/testing/sanitized.h"

namespace palpate::io {
namespace {

using FieldPointer = std::shared_ptr<const DistanceField>;

struct EditedBody {
  std::string name;
  FieldPointer field;
  double extent = 0;
};

glm::dmat3 turned(double degrees) {
  return glm::dmat3(glm::rotate(glm::dmat4(1), glm::radians(degrees), glm::normalize(Vec3(1, 2, 3))));
}

std::vector<EditedBody> seeded_bodies() {
  const auto ball = [](double radius, const Vec3& center) {
    return [=](const Vec3& at) { return glm::distance(at, center) < radius; };
  };
  const auto egg = [](const Vec3& at) { return glm::length(at / Vec3(21, 14, 17)) < 1; };
  const auto plate = [](const Vec3& at) { return std::abs(at.z) < 1.6 && glm::length(glm::dvec2(at)) < 22; };
  const auto merged = [&](const Vec3& at) { return ball(13, {-10, 0, 0})(at) || ball(13, {10, 1, 2})(at); };
  DistanceOptions near;
  near.reach_mm = 5;
  std::vector<EditedBody> bodies;
  const auto add = [&](const std::string& name, const InsideOf& inside, const LabelLattice& lattice) {
    bodies.push_back({name, distance_of(made_labels(inside, 36, lattice), near), 36});
  };
  add("egg", egg, {});
  add("oblique egg", egg, {.spacing = {0.9, 1.1, 1.3}, .axes = turned(33)});
  add("uneven ball", ball(17, {0.3, 0.2, -0.4}), {.spacing = {1, 1, 2}, .unevenness = 0.2});
  add("tilted ball", ball(17, {0.3, 0.2, -0.4}), {.spacing = {1, 1, 2}, .axes = turned(10), .tilt_per_slice = 0.4});
  add("thin plate", plate, {});
  add("merged balls", merged, {});
  return bodies;
}

const std::vector<EditedBody>& bodies() {
  static const std::vector<EditedBody> all = seeded_bodies();
  return all;
}

/// A trace on the edge around a place, then moved outwards by a smooth hill of so many mm.
TraceEdit trace_around(const DistanceField& field, const Vec3& center, double radius, double hill_mm,
                       double reach = 8) {
  TraceEdit trace{.points_mm = {}, .known_to_mm = {}, .reach_mm = reach};
  for (const OutlinePlace& place : outline_places(field, 2.0)) {
    const double r = glm::distance(place.place_mm, center) / radius;
    if (r < 1) trace.points_mm.push_back(place.place_mm - hill_mm * (1 - r * r) * (1 - r * r) * place.inward);
  }
  return trace;
}

Vec3 some_place(const DistanceField& field, std::mt19937& random) {
  const auto places = outline_places(field, 4);
  return places[random() % places.size()].place_mm;
}

/// Those that a thinning to a quarter of the reach keeps.
std::vector<Vec3> kept_of(const TraceEdit& trace) {
  std::vector<Vec3> kept;
  for (const Vec3& point : trace.points_mm) {
    if (std::ranges::none_of(kept, [&](const Vec3& one) { return glm::distance(one, point) < trace.reach_mm / 4; })) {
      kept.push_back(point);
    }
  }
  return kept;
}

bool same_bits(const Distance& a, const Distance& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

TEST(EditsLaws, ATraceGoesThroughItsPoints) {
  std::mt19937 random(5);
  for (const EditedBody& body : bodies()) {
    for (const double hill : {-2.0, 2.5}) {
      if (body.name == "thin plate" && hill < 0) continue;  // it would press one wall through the other
      const TraceEdit trace = trace_around(*body.field, some_place(*body.field, random), 9, hill);
      EditOutcome outcome;
      const FieldPointer edited = apply_edit(body.field, trace, {}, &outcome);
      const std::vector<Vec3> kept = kept_of(trace);
      EXPECT_EQ(outcome.points, kept.size());
      double largest = 0;
      for (const Vec3& point : kept) largest = std::max(largest, std::abs(edited->sample(point).mm));
      EXPECT_LT(largest, 0.05) << body.name << ", hill of " << hill;
    }
  }
}

TEST(EditsLaws, BeyondTheReachTheEdgeKeepsItsBits) {
  std::mt19937 random(6);
  for (const EditedBody& body : bodies()) {
    const TraceEdit trace = trace_around(*body.field, some_place(*body.field, random), 7, 1.5);
    const FieldPointer edited = apply_edit(body.field, trace);
    // What interpolation reads: nodes so far away, whose own nearest edge may lie as much farther.
    const double cell = 4 * glm::length(body.field->parts().near.lattice.spacing);
    std::uniform_real_distribution<double> any(-body.extent, body.extent);
    std::size_t asked = 0, changed = 0;
    for (int n = 0; n < 60000; ++n) {
      const Vec3 at(any(random), any(random), any(random));
      const double mm = std::abs(body.field->sample(at).mm);
      if (mm > body.field->reach_mm()) continue;
      double away = 1e9;
      for (const Vec3& point : trace.points_mm) away = std::min(away, glm::distance(point, at));
      // Its nearest edge, before and after, lies beyond the reach.
      if (away < trace.reach_mm + mm + cell) continue;
      ++asked;
      changed += same_bits(body.field->sample(at), edited->sample(at)) ? 0 : 1;
    }
    EXPECT_GT(asked, 500U) << body.name;
    EXPECT_EQ(changed, 0U) << body.name;
  }
}

TEST(EditsLaws, AfterAnEditItIsADistanceAgain) {
  // Against the distance to the points of its own surface.
  std::mt19937 random(7);
  for (const EditedBody& body : bodies()) {
    if (body.name == "thin plate") continue;  // its own ridges are no distance between nodes
    const Vec3 center = some_place(*body.field, random);
    const FieldPointer edited = apply_edit(body.field, trace_around(*body.field, center, 9, 2.5));
    const std::vector<OutlinePlace> surface = outline_places(*edited, 0.7);
    std::normal_distribution<double> any(0, 6);
    double largest = 0;
    for (int n = 0; n < 400; ++n) {
      const Vec3 at = center + Vec3(any(random), any(random), any(random));
      const double mm = edited->sample(at).mm;
      if (std::abs(mm) > 20) continue;
      double nearest = 1e9;
      for (const OutlinePlace& place : surface) nearest = std::min(nearest, glm::distance(place.place_mm, at));
      largest = std::max(largest, std::abs(std::abs(mm) - nearest));
    }
    EXPECT_LT(largest, 0.8) << body.name;
  }
}

TEST(EditsLaws, ItIsOnceDifferentiable) {
  std::mt19937 random(8);
  for (const EditedBody& body : bodies()) {
    const Vec3 center = some_place(*body.field, random);
    const std::vector<Edit> edits{trace_around(*body.field, center, 8, 2),
                                  AddEdit{{.path_mm = {center, center + Vec3(4, 3, 0)}, .radius_mm = 3}}};
    const FieldPointer edited = apply_edits(body.field, edits).field;
    std::normal_distribution<double> any(0, 8);
    for (int n = 0; n < 3000; ++n) {
      const Vec3 at = center + Vec3(any(random), any(random), any(random));
      const Vec3 step = 1e-6 * glm::normalize(Vec3(any(random), any(random), any(random)));
      const Distance here = edited->sample(at), there = edited->sample(at + step);
      ASSERT_NEAR(there.mm, here.mm + glm::dot(here.gradient, step), 1e-8) << body.name;
      ASSERT_LT(glm::distance(here.gradient, there.gradient), 1e-4) << body.name;
    }
  }
}

TEST(EditsLaws, ATraceOfTheEdgeAsItIsChangesNothing) {
  std::mt19937 random(9);
  for (const EditedBody& body : bodies()) {
    const FieldPointer edited =
        apply_edit(body.field, trace_around(*body.field, some_place(*body.field, random), 12, 0));
    double largest = 0;
    for (const OutlinePlace& place : outline_places(*body.field, 1)) {
      largest = std::max(largest, std::abs(edited->sample(place.place_mm).mm - body.field->sample(place.place_mm).mm));
    }
    EXPECT_LT(largest, 0.01) << body.name;
  }
}

TEST(EditsLaws, EditsFarFromEachOtherCommute) {
  for (const EditedBody& body : bodies()) {
    const auto places = outline_places(*body.field, 4);
    const auto [low, high] =
        std::ranges::minmax_element(places, [](const auto& a, const auto& b) { return a.place_mm.x < b.place_mm.x; });
    const Edit first = trace_around(*body.field, low->place_mm, 5, 1, 4);
    const Edit second = RemoveEdit{{.path_mm = {high->place_mm}, .radius_mm = 3}};
    const FieldPointer one = apply_edits(body.field, std::vector<Edit>{first, second}).field;
    const FieldPointer other = apply_edits(body.field, std::vector<Edit>{second, first}).field;
    std::size_t asked = 0;
    for (const auto& places_of : {outline_places(*one, 1), outline_places(*other, 1)}) {
      for (const OutlinePlace& place : places_of) {
        ++asked;
        EXPECT_NEAR(one->sample(place.place_mm).mm, other->sample(place.place_mm).mm, 1e-3) << body.name;
      }
    }
    EXPECT_GT(asked, 1000U);
  }
}

TEST(EditsLaws, TheFieldBeforeKeepsItsBits) {
  // To undo is to take it again; and the same edit gives the same bits on one thread and on several.
  const EditedBody& body = bodies()[1];
  std::mt19937 random(10);
  std::vector<Vec3> at;
  std::vector<Distance> before;
  std::uniform_real_distribution<double> any(-body.extent, body.extent);
  for (int n = 0; n < 20000; ++n) {
    at.emplace_back(any(random), any(random), any(random));
    before.push_back(body.field->sample(at.back()));
  }
  const TraceEdit trace = trace_around(*body.field, some_place(*body.field, random), 9, 2);
  const FieldPointer one = apply_edit(body.field, trace, {.threads = 1}),
                     three = apply_edit(body.field, trace, {.threads = 3});
  std::size_t moved = 0;
  for (std::size_t n = 0; n < at.size(); ++n) {
    ASSERT_TRUE(same_bits(body.field->sample(at[n]), before[n]));
    ASSERT_TRUE(same_bits(one->sample(at[n]), three->sample(at[n])));
    moved += same_bits(one->sample(at[n]), before[n]) ? 0 : 1;
  }
  EXPECT_GT(moved, 100U);
}

TEST(EditsLaws, OnlyTouchedBricksTakeMemory) {
  const EditedBody& body = bodies()[0];
  const FieldPointer edited = apply_edit(body.field, RemoveEdit{{.path_mm = {Vec3(21, 0, 0)}, .radius_mm = 2}});
  std::size_t shared = 0;
  const auto& before = body.field->parts();
  for (const float* brick : edited->parts().brick) {
    shared += std::ranges::find(before.brick, brick) != before.brick.end() ? 1 : 0;
  }
  EXPECT_GT(shared, before.brick.size() / 2);
  EXPECT_LT(shared, edited->parts().brick.size());
}

TEST(EditsLaws, JoinsAndCutsAreExactAwayFromTheirSeam) {
  DistanceOptions near;
  near.reach_mm = 5;
  const FieldPointer ball = distance_of(made_labels([](const Vec3& at) { return glm::length(at) < 18; }, 36, {}), near);
  const Vec3 end(27, 0, 0);
  const Tube tube{.path_mm = {Vec3(12, 0, 0), end}, .radius_mm = 5};
  const FieldPointer more = apply_edit(ball, AddEdit{tube}), less = apply_edit(ball, RemoveEdit{tube});
  std::mt19937 random(11);
  std::normal_distribution<double> any;
  for (int n = 0; n < 500; ++n) {
    Vec3 way = glm::normalize(Vec3(std::abs(any(random)), any(random), any(random)));
    EXPECT_NEAR(more->sample(end + 5.0 * way).mm, 0, 0.06);  // the cap that stands out
    way.x = -way.x;
    EXPECT_TRUE(same_bits(more->sample(18.0 * way), ball->sample(18.0 * way)));
    if (glm::length(glm::dvec2(way.y, way.z)) < 0.6) {  // the bottom of the hole, inside the ball
      EXPECT_NEAR(less->sample(Vec3(12, 0, 0) + 5.0 * way).mm, 0, 0.06);
    }
    const double turn = any(random);
    const Vec3 side(22 + 0.5 * any(random), 5 * std::cos(turn), 5 * std::sin(turn));
    EXPECT_NEAR(more->sample(side).mm, 0, 0.06);
  }
  EXPECT_GT(more->sample(Vec3(25, 0, 0)).mm, 3.5);
  EXPECT_LT(less->sample(Vec3(14, 0, 0)).mm, -2);
}

TEST(EditsLaws, APartFarFromTheStructureIsAddedAndTakenAway) {
  // Beyond the bricks that there are: the lattice grows, before its beginning too.
  DistanceOptions near;
  near.reach_mm = 3;
  const FieldPointer ball = distance_of(made_labels([](const Vec3& at) { return glm::length(at) < 9; }, 12, {}), near);
  for (const Vec3& center : {Vec3(-31, -29, 4), Vec3(33, 2, -30)}) {
    const FieldPointer two = apply_edit(ball, AddEdit{{.path_mm = {center}, .radius_mm = 8}});
    EXPECT_NEAR(two->sample(center + Vec3(8, 0, 0)).mm, 0, 0.06);
    EXPECT_NEAR(two->sample(center + Vec3(0, 0, -10)).mm, -2, 0.1);
    EXPECT_NEAR(two->sample(center).mm, 8, 2);  // the coarse lattice rounds its peak
    EXPECT_TRUE(same_bits(two->sample({0, 0, 8.5}), ball->sample({0, 0, 8.5})));
    const FieldPointer one = apply_edit(two, RemoveEdit{{.path_mm = {center}, .radius_mm = 11}});
    EXPECT_LT(one->sample(center).mm, -15);
    EXPECT_EQ(outline_places(*one, 2).size(), outline_places(*ball, 2).size());
  }
  EXPECT_THROW(apply_edit(ball, RemoveEdit{{.path_mm = {Vec3(0)}, .radius_mm = 20}}), palpate::InvalidInput);
}

TEST(EditsLaws, APointThatIsKnownBadlyPullsLess) {
  const EditedBody& body = bodies()[0];
  const Vec3 out(23, 0, 0);
  double before = 3;
  for (const double known_to : {0.0, 1.0, 3.0, 8.0}) {
    TraceEdit trace{.points_mm = {out}, .known_to_mm = {known_to}};
    const double left = -apply_edit(body.field, trace)->sample(out).mm;
    if (known_to == 0) {
      EXPECT_LT(std::abs(left), 0.05);
    } else {
      EXPECT_GT(left, before + 0.05);
    }
    before = left;
  }
}

TEST(EditsLaws, APointThatIsKnownToNothingChangesNothing) {
  const EditedBody& body = bodies()[0];
  const std::vector<Vec3> places = {{23, 0, 0}, {0, 15, 0}, {0, 0, -18.5}};
  const auto alone = apply_edit(body.field, TraceEdit{.points_mm = {places[0]}, .known_to_mm = {0}, .reach_mm = 16});
  for (const double known_to : {1e5, 1e9, 1e155, 1e160, 1e308}) {
    for (std::size_t count = 2; count <= places.size(); ++count) {
      TraceEdit trace{.points_mm = {places.begin(), places.begin() + static_cast<std::ptrdiff_t>(count)},
                      .known_to_mm = std::vector<double>(count, known_to),
                      .reach_mm = 16};
      trace.known_to_mm[0] = 0;
      const auto both = apply_edit(body.field, trace);
      for (const Vec3& place : {places[0], places[1], places[2], Vec3(17, 8, 3), Vec3(9, -9, 9)}) {
        EXPECT_NEAR(both->sample(place).mm, alone->sample(place).mm, 0.02) << known_to << ' ' << count;
      }
    }
  }
}

// In the middle of a plate, of a ball and of a rod the distance may have no slope at all: the point is refused in
// words, or the edge comes to it.
TEST(EditsLaws, APointInTheMiddleIsReachedOrRefused) {
  const auto plate = [](double half) { return [=](const Vec3& at) { return std::abs(at.z) < half; }; };
  const auto ball = [](double half) { return [=](const Vec3& at) { return glm::length(at) < half; }; };
  const auto rod = [](double half) { return [=](const Vec3& at) { return glm::length(glm::dvec2(at)) < half; }; };
  DistanceOptions near;
  near.reach_mm = 8;
  int refused = 0, reached = 0;
  for (const double half : {4.0, 4.5, 5.0, 5.5, 6.0, 6.5, 7.0}) {
    for (const InsideOf& inside : {InsideOf(plate(half)), InsideOf(ball(half)), InsideOf(rod(half))}) {
      const FieldPointer field = distance_of(made_labels(inside, 24, {}), near);
      for (const double reach : {2.0, 8.0, 9.5}) {
        for (const Vec3& at : {Vec3(0), Vec3(0, 0, 1e-9), Vec3(0.5), Vec3(3, 3, 0)}) {
          try {
            const auto edited = apply_edit(field, TraceEdit{.points_mm = {at}, .known_to_mm = {}, .reach_mm = reach});
            EXPECT_LT(std::abs(edited->sample(at).mm), 0.5) << half << ' ' << reach;
            ++reached;
          } catch (const InvalidInput&) {
            ++refused;
          }
        }
      }
    }
  }
  EXPECT_GT(refused, 20);
  EXPECT_GT(reached, 5);
}

/// A ball of 34 mm, and a wavy ring of 200 points that stands out of it.
TraceEdit wavy_trace() {
  TraceEdit trace;
  for (int n = 0; n < 200; ++n) {
    const double turn = n * 2 * 3.14159265358979 / 200 * 0.94;
    trace.points_mm.push_back(35.5 * Vec3(std::cos(turn), std::sin(turn), 0.1 * std::sin(3 * turn)));
  }
  return trace;
}

TEST(EditsLaws, ATraceOf200PointsTakesAPartOfWhatTheFieldDid) {
  if (is_sanitized) GTEST_SKIP() << "the checks of sanitizers take their own time";
  DistanceOptions near;
  near.reach_mm = 3;
  near.threads = 1;
  const Mask labels = made_labels([](const Vec3& at) { return glm::length(at) < 34; }, 44, {});
  // Of a processor: what else the machine does takes no part. In turn, so that it meets both.
  const auto least_of = [](double& least, const auto& work) {
    const std::clock_t from = std::clock();
    work();
    least = std::min(least, static_cast<double>(std::clock() - from) / CLOCKS_PER_SEC);
  };
  FieldPointer ball;
  double made = 1e9, edited = 1e9;
  for (int n = 0; n < 3; ++n) {
    least_of(made, [&] { ball = distance_of(labels, near); });
    least_of(edited, [&] { apply_edit(ball, wavy_trace(), {.threads = 1}); });
  }
  constexpr double measured = 0.12, room = 1.5;
  std::printf("a trace of 200 points: %.0f ms of a processor; the field: %.0f ms\n", 1e3 * edited, 1e3 * made);
  EXPECT_LT(edited, room * measured * made);
}

}  // namespace
}  // namespace palpate::io
