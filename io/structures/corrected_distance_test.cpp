// How near to the truth a falsified outline comes when a trembling hand traces the true edge: bodies whose distance is
// known exactly, errors of every type, seeded directions and hands, voxels of 1 mm.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "io/structures/edits.h"
#include "io/structures/outline_places.h"
#include "io/testing/made_labels.h"

namespace palpate::io {
namespace {

using ExactMm = std::function<double(const Vec3&)>;  // positive inside
constexpr double half_box_mm = 24, off_by_mm = 1, traced_beyond_mm = 0.3, hand_mm = 0.2;

struct ExactBody {
  std::string name;
  ExactMm mm;
  std::function<Vec3(const Vec3& way)> outermost;  // the place that lies farthest that way
};

std::vector<ExactBody> exact_bodies() {
  const Vec3 end(9, -7, 5);
  return {{"ball", [](const Vec3& at) { return 16 - glm::length(at); }, [](const Vec3& way) { return 16.0 * way; }},
          {"capsule",
           [=](const Vec3& at) {
             const double along = std::clamp(glm::dot(at, end) / glm::dot(end, end), -1.0, 1.0);
             return 10 - glm::distance(at, along * end);
           },
           [=](const Vec3& way) { return (glm::dot(way, end) < 0 ? -1.0 : 1.0) * end + 10.0 * way; }},
          {"ring",
           [](const Vec3& at) {
             const double round = glm::length(glm::dvec2(at)) - 12;
             return 7 - std::sqrt(round * round + at.z * at.z);
           },
           [](const Vec3& way) { return Vec3(12.0 * glm::normalize(glm::dvec2(way)), 0) + 7.0 * way; }}};
}

const std::vector<std::string> errors_of_outlines{"cap of 5 mm cut off", "dent of 5 mm", "bulge of 4 mm",
                                                  "shift of 2.5 mm"};

ExactMm with_error(const ExactBody& body, std::size_t error, const Vec3& way) {
  const Vec3 top = body.outermost(way);
  const ExactMm mm = body.mm;
  switch (error) {
    case 0:
      return [=](const Vec3& at) { return std::min(mm(at), glm::dot(top - at, way) - 5); };
    case 1:
      return [=](const Vec3& at) { return std::min(mm(at), glm::distance(at, top + 5.0 * way) - 10); };
    case 2:
      return [=](const Vec3& at) { return std::max(mm(at), 8 - glm::distance(at, top - 4.0 * way)); };
    default:
      return [=](const Vec3& at) { return mm(at - 2.5 * way); };
  }
}

double mean_off(const DistanceField& field, const std::vector<Vec3>& where, const ExactMm& truth) {
  double sum = 0;
  std::size_t count = 0;
  for (const OutlinePlace& place : outline_places(field, 1)) {
    // The true edge beside it is one of those that were traced.
    Vec3 on_edge = place.place_mm;
    for (int step = 0; step < 3; ++step) {
      constexpr double h = 1e-4;
      Vec3 slope(0);
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 aside(0);
        aside[axis] = h;
        slope[axis] = (truth(on_edge + aside) - truth(on_edge - aside)) / (2 * h);
      }
      on_edge -= truth(on_edge) * slope;
    }
    if (std::ranges::none_of(where, [&](const Vec3& at) { return glm::distance(at, on_edge) < 1.5; })) continue;
    sum += std::abs(truth(place.place_mm));
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

TEST(CorrectedDistance, IsAtMost03MmInTheMeanOnVoxelsOf1Mm) {
  double worst = 0, sum = 0;
  std::size_t count = 0;
  for (const ExactBody& body : exact_bodies()) {
    const auto truth = distance_of(made_labels([&](const Vec3& at) { return body.mm(at) > 0; }, half_box_mm));
    for (std::size_t error = 0; error < errors_of_outlines.size(); ++error) {
      for (unsigned seed = 0; seed < 2; ++seed) {
        SCOPED_TRACE(body.name + ", " + errors_of_outlines[error] + ", seed " + std::to_string(seed));
        std::mt19937 random(seed + 1);
        std::normal_distribution<double> any;
        // Braces: they are drawn in this order by every compiler.
        Vec3 way{any(random), any(random), any(random)};
        if (body.name == "ring") way.z = 0;
        way = glm::normalize(way);
        const ExactMm spoilt = with_error(body, error, way);
        const auto outline = distance_of(made_labels([&](const Vec3& at) { return spoilt(at) > 0; }, half_box_mm));
        std::vector<Vec3> where;
        TraceEdit trace{.points_mm = {}, .known_to_mm = {}, .reach_mm = 12};
        for (const OutlinePlace& place : outline_places(*truth, 2)) {
          Vec3 at = place.place_mm;
          at -= body.mm(at) * place.inward;  // exactly on the edge
          const double off = std::abs(outline->sample(at).mm);
          // One side of the body, and a little farther than it is corrected, as a hand would.
          if (off < traced_beyond_mm || glm::dot(at, way) < 0.4 * glm::length(at)) continue;
          if (off > off_by_mm) where.push_back(at);
          trace.points_mm.push_back(at + hand_mm * Vec3{any(random), any(random), any(random)});
          trace.known_to_mm.push_back(2 * hand_mm);
        }
        ASSERT_GT(where.size(), 10U);
        const double before = mean_off(*outline, where, body.mm);
        const double after = mean_off(*apply_edit(outline, trace), where, body.mm);
        EXPECT_GT(before, 1.2);
        EXPECT_LE(after, 0.3) << "was " << before;
        worst = std::max(worst, after);
        sum += after;
        ++count;
      }
    }
  }
  std::printf("%zu corrections: %.2f mm in the mean, %.2f mm at most\n", count, sum / static_cast<double>(count),
              worst);
}

}  // namespace
}  // namespace palpate::io
