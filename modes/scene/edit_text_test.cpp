// The text of edits: what it holds comes through, and what is wrong with it is named by its key.

#include "modes/scene/edit_text.h"

#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

#include "solver/text/testing/shown.h"

namespace palpate::modes {
namespace {

std::string refusal_of_edits(const std::string& text) {
  return testing::said_when([&] { edits_from_json(text, "mend.json"); });
}

std::string one_edit(const std::string& members) {
  return R"({"version": 1, "edits": [{)" + members + "}]}";
}

TEST(EditText, HoldsEditsOfEveryKindInTheirOrder) {
  const std::vector<io::Edit> edits = edits_from_json(R"({"version": 1, "edits": [
    {"type": "trace", "points_mm": [[1, 2, 3], [4, 5, 6.5]], "known_to_mm": [0.5, 0], "reach_mm": 12},
    {"type": "trace", "points_mm": [[1, 2, 3]]},
    {"type": "add", "path_mm": [[0, 0, 1]], "radius_mm": 4},
    {"type": "remove", "path_mm": [[0, 0, 1], [0, -2, 1]], "radius_mm": 0.25},
    {"type": "scan_edge", "center_mm": [7, 8, 9], "radius_mm": 11, "most_mm": 2},
    {"type": "contours", "loops_mm": [[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 2]]]}]})",
                                                      "mend.json");
  using io::Vec3;
  const std::vector<io::Edit> wanted{
      io::TraceEdit{.points_mm = {Vec3(1, 2, 3), Vec3(4, 5, 6.5)}, .known_to_mm = {0.5, 0}, .reach_mm = 12},
      io::TraceEdit{.points_mm = {Vec3(1, 2, 3)}, .known_to_mm = {}, .reach_mm = 8},
      io::AddEdit{{.path_mm = {Vec3(0, 0, 1)}, .radius_mm = 4}},
      io::RemoveEdit{{.path_mm = {Vec3(0, 0, 1), Vec3(0, -2, 1)}, .radius_mm = 0.25}},
      io::ScanEdgeEdit{.center_mm = Vec3(7, 8, 9), .radius_mm = 11, .most_mm = 2},
      io::ContoursEdit{{{Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {Vec3(0, 0, 2)}}}};
  EXPECT_EQ(edits, wanted);
  EXPECT_TRUE(edits_from_json(R"({"version": 1, "edits": []})", "mend.json").empty());
}

TEST(EditText, NamesTheKeyThatIsWrong) {
  EXPECT_EQ(refusal_of_edits("[]"), "mend.json: edits: is not an object in braces");
  EXPECT_EQ(refusal_of_edits(R"({"edits": []})"), "mend.json: version: is missing");
  EXPECT_EQ(refusal_of_edits(R"({"version": 2, "edits": []})"),
            "mend.json: version: 2 is not known; this program reads 1");
  EXPECT_EQ(refusal_of_edits(R"({"version": 1, "edits": {}})"), "mend.json: edits: is not a list");
  EXPECT_EQ(refusal_of_edits(R"({"version": 1, "edits": [], "author": "me"})"),
            "mend.json: author: there is no such key here; there are: edits, version");
  EXPECT_EQ(refusal_of_edits(one_edit(R"("type": "cut")")),
            "mend.json: edits[0].type: there is no \"cut\"; there are: trace, add, remove, scan_edge, contours");
  EXPECT_EQ(refusal_of_edits(one_edit(R"("type": "trace", "points_mm": [[1, 2, "3"]])")),
            "mend.json: edits[0].points_mm[0][2]: \"3\" is not a number");
  EXPECT_EQ(refusal_of_edits(one_edit(R"("type": "trace", "points_mm": [[1, 2]])")),
            "mend.json: edits[0].points_mm[0]: is not a list of 3");
  EXPECT_EQ(refusal_of_edits(one_edit(R"("type": "add", "path_mm": [[1, 2, 3]])")),
            "mend.json: edits[0].radius_mm: is missing");
  EXPECT_EQ(refusal_of_edits(one_edit(R"("type": "add", "path_mm": [], "radius_mm": 1, "reach_mm": 2)")),
            "mend.json: edits[0].reach_mm: there is no such key here; there are: path_mm, radius_mm, type");
  EXPECT_EQ(refusal_of_edits(one_edit(R"("type": "add", "type": "remove")")), "mend.json: type: is given twice");
  EXPECT_NE(refusal_of_edits(R"({"version": 1)").find("mend.json: "), std::string::npos);
  EXPECT_EQ(testing::said_when([] { load_edits("/no/such.json"); }),
            "/no/such.json: no such file of edits can be read");
}

}  // namespace
}  // namespace palpate::modes
