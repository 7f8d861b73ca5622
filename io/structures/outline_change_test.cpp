// The reported change of a correction, against balls with caps of a known size.
#include "io/structures/outline_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <vector>

#include "io/structures/edits.h"
#include "io/structures/outline_places.h"
#include "io/testing/made_labels.h"

namespace palpate::io {
namespace {

constexpr double pi = 3.14159265358979;

std::shared_ptr<const DistanceField> changed_ball() {
  return distance_of(made_labels([](const Vec3& at) { return glm::length(at) < 15; }, 30, {.axes = glm::dmat3(1)}),
                     {.reach_mm = 8});
}

/// What two balls share, whose centers are d apart.
double lens_mm3(double r, double s, double d) {
  return pi * (r + s - d) * (r + s - d) * (d * d + 2 * d * (r + s) - 3 * (r - s) * (r - s)) / (12 * d);
}

TEST(OutlineChange, OfAnAddedAndARemovedBallIsThatOfTheFormula) {
  const auto before = changed_ball();
  const double ball = 4.0 / 3 * pi * 5 * 5 * 5;
  const AddEdit add{{.path_mm = {{0, 15, 0}}, .radius_mm = 5}};
  const RemoveEdit remove{{.path_mm = {{0, -15, 0}}, .radius_mm = 5}};
  for (const std::vector<Edit>& edits : {std::vector<Edit>{add}, {remove}, {add, remove}}) {
    const auto box = box_of_edits(edits);
    ASSERT_TRUE(box);
    const OutlineChange change = outline_change(*before, *apply_edits(before, edits).field, *box);
    const bool adds = edits.front().index() == Edit(add).index(),
               removes = edits.back().index() == Edit(remove).index();
    EXPECT_NEAR(change.added_mm3, adds ? ball - lens_mm3(15, 5, 15) : 0, 40);  // and its seam
    EXPECT_NEAR(change.removed_mm3, removes ? lens_mm3(15, 5, 15) : 0, 40);
    EXPECT_NEAR(change.largest_mm, 5, 0.2);
    EXPECT_LT(std::hypot(change.largest_at_mm.x, change.largest_at_mm.z), 2);
    EXPECT_TRUE(adds ? removes || change.largest_at_mm.y > 0 : change.largest_at_mm.y < 0);
  }
}

/// A part beside the ball, a rod on it and a hole drilled into it: the farthest place is the one that is farthest from
/// the other outline, whether that is the old one or the new one.
TEST(OutlineChange, TellsTheLargestMoveOfWhatComesAndOfWhatGoes) {
  const auto ball = distance_of(made_labels([](const Vec3& at) { return glm::length(at) < 15; }, 32), {.reach_mm = 15});
  struct Move {
    Edit edit;
    double largest_mm = 0, at_y = 0;
  };
  const std::vector<Move> moves{{AddEdit{{.path_mm = {{0, 22, 0}}, .radius_mm = 4}}, 11, 26},
                                {AddEdit{{.path_mm = {{0, -25, 0}}, .radius_mm = 4}}, 14, -29},
                                {AddEdit{{.path_mm = {{0, 10, 0}, {0, 24, 0}}, .radius_mm = 3}}, 12, 27},
                                {RemoveEdit{{.path_mm = {{0, 18, 0}, {0, 7, 0}}, .radius_mm = 3}}, 11, 4}};
  for (const Move& move : moves) {
    const std::vector<Edit> edits{move.edit};
    const auto changed = apply_edits(ball, edits).field;
    for (const bool is_undone : {false, true}) {
      const OutlineChange change = is_undone ? outline_change(*changed, *ball, *box_of_edits(edits))
                                             : outline_change(*ball, *changed, *box_of_edits(edits));
      SCOPED_TRACE(::testing::Message() << name_of(move.edit) << " up to " << move.at_y
                                        << (is_undone ? ", undone" : ""));
      EXPECT_NEAR(change.largest_mm, move.largest_mm, 0.5);
      EXPECT_LT(glm::distance(change.largest_at_mm, Vec3(0, move.at_y, 0)), 2);
    }
  }
}

TEST(OutlineChange, OfNoEditAndOfATraceOfTheEdgeAsItIsIsNone) {
  EXPECT_FALSE(box_of_edits({}));
  const auto before = changed_ball();
  std::vector<Vec3> along;
  for (const OutlinePlace& place : outline_places(*before, 2)) {
    if (glm::distance(place.place_mm, Vec3(15, 0, 0)) < 9) along.push_back(place.place_mm);
  }
  const std::vector<Edit> edits{TraceEdit{.points_mm = along, .known_to_mm = {}}};
  const OutlineChange change = outline_change(*before, *apply_edits(before, edits).field, *box_of_edits(edits));
  EXPECT_LT(change.largest_mm, 0.05);
  EXPECT_LT(change.added_mm3 + change.removed_mm3, 2);
}

TEST(OutlineChange, NoEdgeMovesOutsideOfTheBox) {
  const auto before = changed_ball();
  const std::vector<std::vector<Edit>> all{{TraceEdit{.points_mm = {{19, 0, 0}}, .known_to_mm = {}}},
                                           {TraceEdit{.points_mm = {{12, 3, 0}}, .known_to_mm = {}, .reach_mm = 12}},
                                           {AddEdit{{.path_mm = {{10, 0, 0}, {22, 0, 5}}, .radius_mm = 4}}},
                                           {RemoveEdit{{.path_mm = {{15, 0, 0}, {0, 15, 0}}, .radius_mm = 3}}}};
  for (const std::vector<Edit>& edits : all) {
    const StructureBox box = *box_of_edits(edits);
    const auto after = apply_edits(before, edits).field;
    bool moved = false;
    for (const OutlinePlace& place : outline_places(*after, 1)) {
      const bool is_in = glm::all(glm::greaterThan(place.place_mm, box.low_mm)) &&
                         glm::all(glm::lessThan(place.place_mm, box.high_mm));
      const double mm = std::abs(before->sample(place.place_mm).mm);
      moved = moved || mm > 1;
      EXPECT_TRUE(is_in || mm < 0.02) << name_of(edits.front()) << " " << mm;
    }
    EXPECT_TRUE(moved);
  }
}

}  // namespace
}  // namespace palpate::io
