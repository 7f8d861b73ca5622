// The law that an edit makes no part of a structure that it does not touch appear or vanish, over seeded edits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "io/structures/edits.h"
#include "io/structures/outline_parts.h"
#include "io/testing/made_labels.h"
#include "solver/text/message.h"

namespace palpate::io {
namespace {

/// A body with a hole in it, and two islands beside it.
bool in_archipelago(const Vec3& at) {
  const auto ball = [&](const Vec3& center, double radius) { return glm::distance(at, center) < radius; };
  return (ball({0, 0, 0}, 15) && !ball({3, 2, 0}, 5)) || ball({-22, 6, 2}, 4) || ball({4, -21, -4}, 5);
}

/// The places of an edit, and how far from them it changes the edge.
struct SeededEdit {
  Edit edit;
  std::vector<Vec3> places;
  double reach_mm = 0;

  double distance_to(const Vec3& at) const {
    double nearest = 1e9;
    for (const Vec3& place : places) nearest = std::min(nearest, glm::distance(place, at));
    return nearest;
  }
};

SeededEdit seeded_edit(const DistanceField& field, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(0, 1);
  const std::vector<OutlinePlace> outline = outline_places(field, 2);
  const OutlinePlace& start = outline[random() % outline.size()];
  SeededEdit made;
  if (seed % 3 == 0) {
    TraceEdit trace{.points_mm = {}, .known_to_mm = {}, .reach_mm = 4 + 5 * any(random)};
    const double hill = (any(random) - 0.5) * 0.8 * trace.reach_mm;
    for (const OutlinePlace& place : outline) {
      const double r = glm::distance(place.place_mm, start.place_mm) / 7;
      if (r < 1) trace.points_mm.push_back(place.place_mm - hill * (1 - r * r) * place.inward);
    }
    made = {.edit = trace, .places = trace.points_mm, .reach_mm = trace.reach_mm};
  } else {
    Tube tube{.path_mm = {start.place_mm}, .radius_mm = 2 + 4 * any(random)};
    for (int n = 0; n < 5; ++n) {
      tube.path_mm.push_back(tube.path_mm.back() +
                             2.0 * glm::normalize(Vec3(any(random), any(random), any(random)) - 0.5));
    }
    made = {.edit = AddEdit{tube}, .places = tube.path_mm, .reach_mm = tube.radius_mm + 3};
    if (seed % 3 == 1) made.edit = RemoveEdit{tube};
  }
  return made;
}

/// Whether an edit touches a part: some of its surface lies within the reach.
std::vector<char> touched_parts(const DistanceField& field, const SeededEdit& edit, std::vector<OutlinePart>& parts) {
  const std::vector<OutlinePlace> places = outline_places(field, 1);
  std::vector<std::size_t> of_place;
  parts = outline_parts(field, places, &of_place);
  std::vector<char> touched(parts.size());
  for (std::size_t n = 0; n < places.size(); ++n) {
    if (edit.distance_to(places[n].place_mm) >= edit.reach_mm + 1) continue;
    touched[of_place[n]] = 1;
    if (parts[of_place[n]].is_hole) touched[0] = 1;  // the largest part is what the hole lies in
  }
  return touched;
}

TEST(EditPartsLaws, NoPartAppearsOrGoesThatTheEditDoesNotTouch) {
  const auto field = distance_of(made_labels(in_archipelago, 30));
  ASSERT_EQ(outline_parts(*field).size(), 4U);
  std::size_t changed = 0, kept = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    const SeededEdit edit = seeded_edit(*field, seed);
    std::shared_ptr<const DistanceField> edited;
    try {
      edited = apply_edit(field, edit.edit);
    } catch (const InvalidInput&) {
      continue;  // a trace that would leave an island is refused
    }
    std::vector<OutlinePart> before, after;
    const std::vector<char> was_touched = touched_parts(*field, edit, before);
    const std::vector<char> is_touched = touched_parts(*edited, edit, after);
    const auto same = [](const OutlinePart& a, const OutlinePart& b) {
      return a.is_hole == b.is_hole && a.volume_mm3 == b.volume_mm3 && a.deepest_mm == b.deepest_mm;
    };
    for (std::size_t n = 0; n < before.size(); ++n) {
      if (was_touched[n] != 0) continue;
      ++kept;
      EXPECT_TRUE(std::ranges::any_of(after, [&](const OutlinePart& one) { return same(before[n], one); }))
          << "a part went that was not touched";
    }
    for (std::size_t n = 0; n < after.size(); ++n) {
      if (is_touched[n] != 0) continue;
      EXPECT_TRUE(std::ranges::any_of(before, [&](const OutlinePart& one) { return same(after[n], one); }))
          << "a part of " << after[n].volume_mm3 << " mm^3 appeared that is not touched";
    }
    changed += before.size() != after.size() ? 1 : 0;
  }
  EXPECT_GT(kept, 20U);
  EXPECT_GT(changed, 0U) << "an edit that joins or takes away a part is among them";
}

}  // namespace
}  // namespace palpate::io
