#include "plugin/paraview/client/model/mark_rows.h"

#include <gmock/gmock.h>

#include <optional>
#include <string>
#include <vector>

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;
using Kind = MarkRow::Kind;

FeltMark mark(const std::string& name, double x) {
  FeltMark made;
  made.name = name;
  made.position_mm = {x, 0, 0};
  return made;
}

/// Three marks, two paths, the distances between neighbors and the angle.
Marks some() {
  Marks marks;
  marks.points = {mark("Mark 1", 0), mark("Mark 2", 1), mark("Mark 3", 3)};
  marks.points.back().position_mm.y = 4;
  for (const char* const name : {"Path 1", "Path 2"}) {
    marks.paths.emplace_back();
    marks.paths.back().name = name;
    marks.paths.back().points_mm = {{0, 0, 0}, {0, 9, 0}};
  }
  marks.distances = {{.from = 0, .to = 1}, {.from = 1, .to = 2}};
  marks.angles = {{.from = 0, .at = 1, .to = 2}};
  measure_again(marks);
  return marks;
}

constexpr std::nullopt_t is_new = std::nullopt;

TEST(MarkRows, KindsFollowEachOther) {
  EXPECT_THAT(rows_of(some()), ElementsAre(MarkRow{Kind::mark, 0}, MarkRow{Kind::mark, 1}, MarkRow{Kind::mark, 2},
                                           MarkRow{Kind::path, 0}, MarkRow{Kind::path, 1}, MarkRow{Kind::distance, 0},
                                           MarkRow{Kind::distance, 1}, MarkRow{Kind::angle, 0}));
  EXPECT_TRUE(rows_of({}).empty());
}

TEST(MarkRows, ANewMarkTakesTheRowOfNoPath) {
  Marks now = some();
  now.points.push_back(mark("Mark 4", 9));
  EXPECT_THAT(former_rows(some(), now), ElementsAre(0, 1, 2, is_new, 3, 4, 5, 6, 7));
  EXPECT_THAT(former_rows(now, some()), ElementsAre(0, 1, 2, 4, 5, 6, 7, 8)) << "taken back";
}

TEST(MarkRows, WhatWasDeletedInTheMiddleComesBackThere) {
  Marks now = some();
  remove_mark(now, 0);
  ASSERT_EQ(now.distances.size(), 1U);
  EXPECT_THAT(former_rows(some(), now), ElementsAre(1, 2, 3, 4, 6));
  EXPECT_THAT(former_rows(now, some()), ElementsAre(is_new, 0, 1, 2, 3, is_new, 4, is_new));
}

TEST(MarkRows, WhatIsRenamedOrMovedKeepsItsRow) {
  Marks now = some();
  now.points[1].name = "edge of the liver";
  now.points[1].position_mm = {1, 1, 1};
  now.paths[0].name = "along the rib";
  measure_again(now);
  EXPECT_THAT(former_rows(some(), now), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
}

TEST(MarkRows, OfOthersNothingStays) {
  EXPECT_THAT(former_rows({}, some()), ElementsAre(is_new, is_new, is_new, is_new, is_new, is_new, is_new, is_new));
  EXPECT_TRUE(former_rows(some(), {}).empty());
}

}  // namespace
}  // namespace palpate::plugin
