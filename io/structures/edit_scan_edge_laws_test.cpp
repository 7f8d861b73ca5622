// Laws of scan_edge over seeded bodies, errors of their outlines and scans with noise: round, thin, in parts, beside a
// neighbor, and with a side where the scan has no edge.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "io/quantile.h"
#include "io/structures/edge_ways.h"
#include "io/structures/edits.h"
#include "io/structures/outline_parts.h"
#include "io/structures/outline_places.h"
#include "io/testing/made_labels.h"
#include "solver/text/message.h"

namespace palpate::io {
namespace {

using SignedMm = std::function<double(const Vec3&)>;  // positive inside
constexpr double half_scan_mm = 24, scan_noise = 8, scan_blur_mm = 0.7;

SignedMm ball_mm(double radius, const Vec3& center = Vec3(0)) {
  return [=](const Vec3& at) { return radius - glm::distance(at, center); };
}

struct ScannedBody {
  std::string name;
  SignedMm mm;
  SignedMm value;  ///< of the scan, without noise
  bool half_has_no_edge = false;
};

double blurred_step(double mm) {
  return 50 * (1 + std::erf(mm / (scan_blur_mm * std::sqrt(2.0))));
}

std::vector<ScannedBody> scanned_bodies() {
  const auto as_body = [](const std::string& name, const SignedMm& mm) {
    return ScannedBody{name, mm, [=](const Vec3& at) { return blurred_step(mm(at)); }};
  };
  const SignedMm ball = ball_mm(14), beside = ball_mm(9, Vec3(20, 3, 0));
  const SignedMm egg = [](const Vec3& at) { return 13 * (1 - glm::length(at / Vec3(18, 12, 14))); };
  const SignedMm plate = [](const Vec3& at) {
    return std::min(2.4 - std::abs(at.z), 17 - glm::length(glm::dvec2(at)));
  };
  const SignedMm parts = [](const Vec3& at) {
    return std::max(ball_mm(9, {-11, 0, 0})(at), ball_mm(8, {9, 1, 2})(at));
  };
  const SignedMm hollow = [](const Vec3& at) { return std::min(ball_mm(15)(at), -ball_mm(6, {4, 2, 0})(at)); };
  return {as_body("ball", ball),
          as_body("egg", egg),
          as_body("plate", plate),
          as_body("two parts", parts),
          as_body("hollow", hollow),
          {"neighbor", ball, [=](const Vec3& at) { return blurred_step(ball(at)) + 1.6 * blurred_step(beside(at)); }},
          {"half without an edge", ball,
           [=](const Vec3& at) {
             return blurred_step(std::max(ball(at), ball_mm(40, {0, 40, 0})(at)));
           },
           true}};
}

std::shared_ptr<const Volume> scan_of(const ScannedBody& body, unsigned seed) {
  Volume scan;
  scan.geometry = made_labels([](const Vec3&) { return true; }, half_scan_mm).geometry;
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, scan_noise);
  const glm::ivec3 size = scan.geometry.dimensions;
  std::vector<float> voxels;
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        voxels.push_back(static_cast<float>(body.value(scan.geometry.to_patient({i, j, k})) + noise(random)));
      }
    }
  }
  scan.voxels = std::move(voxels);
  return std::make_shared<const Volume>(std::move(scan));
}

constexpr int spoils = 4;

/// An outline that is off: shifted, wavy, without a cap, or rough by a voxel.
SignedMm spoilt(const SignedMm& mm, int how, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  const Vec3 way = glm::normalize(Vec3(any(random), any(random), any(random)));
  const double size = 2 + any(random);
  switch (how) {
    case 0:
      return [=](const Vec3& at) { return mm(at - size * way); };
    case 1:
      return [=](const Vec3& at) {
        return mm(at) +
               size * std::sin(0.5 * at.x + way.x) * std::sin(0.6 * at.y + way.y) * std::sin(0.55 * at.z + way.z);
      };
    case 2:
      return [=](const Vec3& at) { return std::min(mm(at), 9 - glm::dot(at, way)); };
    default:
      return [mm, &random](const Vec3& at) { return mm(at) + std::normal_distribution<double>(0, 0.7)(random); };
  }
}

/// How many parts and holes there are.
std::pair<int, int> counted_parts(const DistanceField& field) {
  std::pair<int, int> counted{0, 0};
  for (const OutlinePart& part : outline_parts(field)) ++(part.is_hole ? counted.second : counted.first);
  return counted;
}

struct ScanEdgeCase {
  std::string name;
  const ScannedBody* body = nullptr;
  unsigned spoil = 0;
  std::shared_ptr<const DistanceField> before, after;  ///< null: refused
  ScanEdgeEdit edit;
  EditOutcome outcome;
  std::shared_ptr<const Volume> scan;
  std::shared_ptr<const FieldSource> fields;
  std::string refusal;
};

std::vector<ScanEdgeCase> made_cases() {
  static const std::vector<ScannedBody> bodies = scanned_bodies();
  std::vector<ScanEdgeCase> cases;
  for (unsigned seed = 0; seed < bodies.size() * spoils; ++seed) {
    std::mt19937 random(seed + 1);
    const ScannedBody& body = bodies[seed / spoils];
    ScanEdgeCase one{
        .name = body.name + ", spoilt " + std::to_string(seed % spoils), .body = &body, .spoil = seed % spoils};
    const SignedMm outline = spoilt(body.mm, seed % spoils, random);
    one.before = distance_of(made_labels([&](const Vec3& at) { return outline(at) > 0; }, half_scan_mm));
    one.scan = scan_of(body, seed);
    one.fields = edge_fields(one.scan);
    const ScanValues values{*one.fields, one.scan->geometry};
    // Where it is off most, among some.
    const std::vector<OutlinePlace> places = outline_places(*one.before, 3);
    Vec3 center = places.front().place_mm;
    for (int n = 0; n < 20; ++n) {
      const Vec3 at = places[random() % places.size()].place_mm;
      if (std::abs(body.mm(at)) > std::abs(body.mm(center))) center = at;
    }
    one.edit = {.center_mm = center,
                .radius_mm = std::uniform_real_distribution<double>(8, 15)(random),
                .most_mm = std::uniform_real_distribution<double>(3, 6)(random)};
    try {
      one.after = apply_edit(one.before, one.edit, {.scan = &values}, &one.outcome);
    } catch (const InvalidInput& error) {
      one.refusal = error.what();
    }
    cases.push_back(std::move(one));
  }
  return cases;
}

const std::vector<ScanEdgeCase>& scan_edge_cases() {
  static const std::vector<ScanEdgeCase> all = made_cases();
  return all;
}

TEST(ScanEdgeLaws, NoneIsRefused) {
  std::size_t accepted = 0, moved = 0;
  for (const ScanEdgeCase& one : scan_edge_cases()) {
    EXPECT_EQ(one.refusal, "") << one.name;
    accepted += one.after ? 1 : 0;
    moved += one.outcome.largest_mm > 0.5 ? 1 : 0;
  }
  std::printf("%zu of %zu accepted, %zu move by more than 0.5 mm\n", accepted, scan_edge_cases().size(), moved);
  EXPECT_GT(2 * moved, accepted);
}

TEST(ScanEdgeLaws, BeyondTheRadiusTheEdgeKeepsItsBits) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-half_scan_mm, half_scan_mm);
  for (const ScanEdgeCase& one : scan_edge_cases()) {
    if (!one.after) continue;
    const double cell = 4 * glm::length(one.before->parts().near.lattice.spacing);
    std::size_t asked = 0, changed = 0;
    for (int n = 0; n < 20000; ++n) {
      const Vec3 at(any(random), any(random), any(random));
      const Distance before = one.before->sample(at), after = one.after->sample(at);
      if (std::abs(before.mm) > one.before->reach_mm()) continue;
      if (glm::distance(at, one.edit.center_mm) < one.edit.radius_mm + std::abs(before.mm) + cell) continue;
      ++asked;
      changed += std::memcmp(&before, &after, sizeof before) == 0 ? 0 : 1;
    }
    EXPECT_GT(asked, 100U) << one.name;
    EXPECT_EQ(changed, 0U) << one.name;
  }
}

TEST(ScanEdgeLaws, ItMovesNoFartherThanAsked) {
  for (const ScanEdgeCase& one : scan_edge_cases()) {
    if (!one.after) continue;
    EXPECT_LE(one.outcome.largest_mm, one.edit.most_mm);
    for (const OutlinePlace& place : outline_places(*one.after, 1)) {
      ASSERT_LT(std::abs(one.before->sample(place.place_mm).mm), one.outcome.largest_mm + 0.1) << one.name;
    }
    for (const OutlinePlace& place : outline_places(*one.before, 1)) {
      ASSERT_LT(std::abs(one.after->sample(place.place_mm).mm), one.outcome.largest_mm + 0.1) << one.name;
    }
  }
}

TEST(ScanEdgeLaws, NoPartOrHoleAppearsOrGoes) {
  for (const ScanEdgeCase& one : scan_edge_cases()) {
    if (!one.after) continue;
    EXPECT_EQ(counted_parts(*one.after), counted_parts(*one.before)) << one.name;
  }
}

TEST(ScanEdgeLaws, WhereTheScanHasNoEdgeItStays) {
  // A lone place without one among those that have one follows them.
  std::size_t without = 0;
  for (const ScanEdgeCase& one : scan_edge_cases()) {
    if (!one.after) continue;
    const ScanValues values{*one.fields, one.scan->geometry};
    std::vector<OutlinePlace> places = outline_places(*one.before, one.edit.radius_mm / 8);
    std::erase_if(places, [&](const OutlinePlace& place) {
      return glm::distance(place.place_mm, one.edit.center_mm) > one.edit.radius_mm - 0.5;
    });
    std::vector<char> has_edge;
    for (const OutlinePlace& place : places) {
      has_edge.push_back(scan_edge(values, *one.before, place.place_mm, place.inward, one.edit.most_mm) ? 1 : 0);
    }
    for (std::size_t n = 0; n < places.size(); ++n) {
      if (has_edge[n] != 0) continue;
      std::size_t all = 0, with_edge = 0;
      for (std::size_t other = 0; other < places.size(); ++other) {
        if (glm::distance(places[n].place_mm, places[other].place_mm) > 0.25 * one.edit.radius_mm) continue;
        ++all;
        with_edge += has_edge[other] != 0 ? 1 : 0;
      }
      if (2 * with_edge > all) continue;
      ++without;
      EXPECT_LT(std::abs(one.after->sample(places[n].place_mm).mm), 0.25) << one.name;
    }
  }
  EXPECT_GT(without, 200U);
}

/// A case and the ways of its places. Of wavy and of rough outlines.
struct WaysOfCase {
  const ScanEdgeCase* of = nullptr;
  std::vector<internal::EdgeWay> places;  ///< within the radius
};

const std::vector<WaysOfCase>& ways_of_cases() {
  static const std::vector<WaysOfCase> all = [] {
    std::vector<WaysOfCase> made;
    for (const ScanEdgeCase& one : scan_edge_cases()) {
      if (!one.after || one.spoil % 2 == 0) continue;
      const internal::EdgeWays ways(*one.before, one.edit, {*one.fields, one.scan->geometry}, 0);
      WaysOfCase& here = made.emplace_back();
      here.of = &one;
      std::ranges::copy_if(ways.places(), std::back_inserter(here.places), [&](const internal::EdgeWay& place) {
        return glm::distance(place.at.place_mm, one.edit.center_mm) < one.edit.radius_mm;
      });
    }
    return made;
  }();
  return all;
}

/// A place that stays because its neighbors disagree has an edge.
TEST(ScanEdgeLaws, OnlyPlacesThatStayWithoutAnEdgeAreToldAsSuch) {
  std::size_t with_an_edge = 0;
  for (const WaysOfCase& one : ways_of_cases()) {
    std::size_t without = 0;
    for (const internal::EdgeWay& place : one.places) {
      if (!place.stays) continue;
      ++(place.has_edge ? with_an_edge : without);
    }
    EXPECT_EQ(one.of->outcome.without_edge, without) << one.of->name;
    EXPECT_EQ(one.of->outcome.points, one.places.size()) << one.of->name;
  }
  EXPECT_GT(with_an_edge, 0U);
}

/// The uncertainty of a place's neighbors counts, and not its own: a place without an edge has none.
TEST(ScanEdgeLaws, AWayWithinTheUncertaintyOfTheEdgesAroundIsNone) {
  constexpr double alike_mm = 1;
  std::size_t within = 0, beyond_their_own = 0;
  for (const WaysOfCase& one : ways_of_cases()) {
    const double around_mm = 2 * std::clamp(one.of->edit.radius_mm / 8, 0.75, 2.0);  // two of their distances
    for (const internal::EdgeWay& place : one.places) {
      std::vector<double> mm, known_to_mm;
      for (const internal::EdgeWay& other : one.places) {
        if (!other.has_edge || !(glm::dot(place.at.inward, other.at.inward) > 0)) continue;
        if (glm::distance(place.at.place_mm, other.at.place_mm) > around_mm) continue;
        mm.push_back(other.edge_mm);
        known_to_mm.push_back(other.known_to_mm);
      }
      const double middle = quantile(mm, 0.5);
      const double way = place.has_edge && std::abs(place.edge_mm - middle) < alike_mm ? place.edge_mm : middle;
      if (place.stays || std::abs(way) > quantile(known_to_mm, 0.5)) continue;
      ++within;
      beyond_their_own += std::abs(way) > place.known_to_mm ? 1 : 0;
      EXPECT_EQ(place.mm, 0) << one.of->name;
    }
  }
  EXPECT_GT(within, 100U);
  EXPECT_GT(beyond_their_own, 0U);
}

TEST(ScanEdgeLaws, ItComesNearerToTheTruth) {
  double before_mm = 0, after_mm = 0;
  for (const ScanEdgeCase& one : scan_edge_cases()) {
    if (!one.after) continue;
    const auto mean = [&](const DistanceField& field) {
      double sum = 0;
      std::size_t count = 0;
      for (const OutlinePlace& place : outline_places(field, 1)) {
        if (glm::distance(place.place_mm, one.edit.center_mm) > 0.5 * one.edit.radius_mm) continue;
        sum += std::abs(one.body->mm(place.place_mm));
        ++count;
      }
      return sum / static_cast<double>(std::max<std::size_t>(count, 1));
    };
    const double was = mean(*one.before), is = mean(*one.after);
    std::printf("%-32s %5.2f -> %5.2f mm; %zu places, %zu without an edge, %zu held back\n", one.name.c_str(), was, is,
                one.outcome.points, one.outcome.without_edge, one.outcome.held_back);
    EXPECT_LT(is, was + 0.15) << one.name;
    // A cap that was cut off lies farther away than it may move, and the ways of a rough outline are as rough.
    if (one.spoil > 1 || one.body->half_has_no_edge) continue;
    before_mm += was;
    after_mm += is;
  }
  std::printf("shifted and wavy ones: %.2f -> %.2f mm in the mean\n", before_mm / 12, after_mm / 12);
  EXPECT_LT(after_mm, 0.35 * before_mm);
}

}  // namespace
}  // namespace palpate::io
