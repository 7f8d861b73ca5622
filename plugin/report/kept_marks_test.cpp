// Marks in state files: all of them are read again, and a changed text is refused in words.

#include "plugin/report/kept_marks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace palpate::plugin {
namespace {

MarksOfScans two_scans() {
  Marks marks;
  marks.points = {{.name = "Mark \"1\", ü",
                   .tick = 7,
                   .time_s = 0.25,
                   .position_mm = {0.1, -2.0 / 3, 1e-9},
                   .boundary = "skin",
                   .value = -302.5,
                   .force_n = 0.5},
                  {.name = "Mark 2", .position_mm = {3, 4, 0}, .value = std::numeric_limits<double>::quiet_NaN()},
                  {.name = "Mark 3", .position_mm = {3, 9, 0}}};
  marks.paths = {{.name = "Path 1", .begin_s = 1, .end_s = 2, .points_mm = {{0, 0, 0}, {3, 4, 0}, {3, 4, 12}}}};
  marks.distances = {{.from = 1, .to = 2}};
  marks.angles = {{.from = 0, .at = 1, .to = 2}};
  Marks other;
  other.points = {{.name = "Mark 1", .position_mm = {1, 1, 1}}};
  return {{"00000000000000aa", marks}, {"00000000000000bb", other}, {"00000000000000cc", {}}};
}

TEST(KeptMarks, ComeBackToTheLastBit) {
  const MarksOfScans before = two_scans();
  const MarksOfScans after = marks_of_text(kept_text(before));
  ASSERT_EQ(after.size(), 2U) << "a scan without marks needs no place";
  const Marks& marks = after.at("00000000000000aa");
  const Marks& wanted = before.at("00000000000000aa");
  ASSERT_EQ(marks.points.size(), 3U);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(marks.points[n].name, wanted.points[n].name);
    EXPECT_EQ(marks.points[n].position_mm, wanted.points[n].position_mm);
    EXPECT_EQ(marks.points[n].boundary, wanted.points[n].boundary);
    EXPECT_EQ(marks.points[n].force_n, wanted.points[n].force_n);
    EXPECT_EQ(marks.points[n].tick, wanted.points[n].tick);
    EXPECT_EQ(marks.points[n].time_s, wanted.points[n].time_s);
  }
  EXPECT_EQ(marks.points[0].value, -302.5);
  EXPECT_TRUE(std::isnan(marks.points[1].value));
  ASSERT_EQ(marks.paths.size(), 1U);
  EXPECT_EQ(marks.paths[0].points_mm, wanted.paths[0].points_mm);
  EXPECT_DOUBLE_EQ(marks.paths[0].length_mm, 17);
  EXPECT_EQ(marks.paths[0].name, "Path 1");
  EXPECT_EQ(marks.paths[0].begin_s, 1);
  EXPECT_EQ(marks.paths[0].touched_mm, wanted.paths[0].touched_mm);
  EXPECT_EQ(marks.paths[0].end_s, 2);
  ASSERT_EQ(marks.distances.size(), 1U);
  EXPECT_DOUBLE_EQ(marks.distances[0].mm, 5);
  ASSERT_EQ(marks.angles.size(), 1U);
  EXPECT_EQ(marks.angles[0].at, 1U);
  EXPECT_EQ(kept_text(after), kept_text(before));
}

TEST(KeptMarks, AreNoTextWhereThereAreNone) {
  EXPECT_EQ(kept_text({{"00000000000000aa", {}}}), "");
  EXPECT_TRUE(marks_of_text("").empty());
}

std::string refusal_of(const std::string& text) {
  try {
    marks_of_text(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

std::string with(const std::string& marks, const std::string& paths, const std::string& distances,
                 const std::string& angles) {
  return R"({"version":1,"scans":{"a":{"marks":[)" + marks + R"(],"paths":[)" + paths + R"(],"distances":[)" +
         distances + R"(],"angles":[)" + angles + "]}}}";
}

TEST(KeptMarks, AChangedTextIsRefusedInWords) {
  const std::string mark =
      R"({"name":"M","tick":0,"time_s":0,"position_mm":[1,2,3],"boundary":"","value":null,"force_n":0})";
  EXPECT_EQ(refusal_of(with(mark, "", "", "")), "");
  EXPECT_EQ(refusal_of(with(mark, "", "[0,1]", "")),
            "The marks cannot be read: a measure is not between marks. Those that are here stay.");
  EXPECT_NE(refusal_of(with(mark, "", "[0,0]", "")).find("between marks"), std::string::npos);
  EXPECT_NE(refusal_of(with(mark + "," + mark, "", "[0,-1]", "")).find("between marks"), std::string::npos);
  EXPECT_NE(refusal_of(with(mark, "", "", "[0,1,2]")).find("between marks"), std::string::npos);
  std::string flat = mark;
  flat.replace(flat.find("[1,2,3]"), 7, "[1,2]");
  EXPECT_NE(refusal_of(with(flat, "", "", "")).find("three numbers"), std::string::npos);
  std::string endless = mark;
  endless.replace(endless.find("[1,2,3]"), 7, "[1,2,1e999]");
  EXPECT_NE(refusal_of(with(endless, "", "", "")), "");
  EXPECT_NE(refusal_of(with("", R"({"name":"P","begin_s":0,"end_s":1,"points_mm":[[0,0,0]]})", "", "")), "");
  EXPECT_NE(refusal_of(R"({"version":2,"scans":{}})").find("another version"), std::string::npos);
  for (const char* const text : {"{", "[]", "null", R"({"version":1})", R"({"version":1,"scans":{"a":3}})"}) {
    EXPECT_NE(refusal_of(text), "") << text;
  }
}

}  // namespace
}  // namespace palpate::plugin
