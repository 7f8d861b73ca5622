// The text of edits: what it holds comes through, and what is wrong with it is named by its key.

#include "modes/scene/edit_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "io/fresh_folder.h"
#include "modes/scene/scene_json.h"
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
  EXPECT_EQ(edits_from_json(to_json(wanted), "again"), wanted);
  EXPECT_TRUE(edits_from_json(R"({"version": 1, "edits": []})", "mend.json").empty());
}

TEST(EditText, ASceneHoldsTheEditsOfAStructureToTheLastBit) {
  std::mt19937 random(44);
  std::uniform_real_distribution<double> any(-300, 300);
  io::TraceEdit trace;
  for (int n = 0; n < 50; ++n) {
    trace.points_mm.emplace_back(any(random), any(random), any(random));
    trace.known_to_mm.push_back(std::abs(any(random)) / 300);
  }
  Scene scene = scene_from_json(R"({"version": 1, "structures": [
    {"name": "liver", "file": "/l.dcm", "segment": 1, "edits": [{"type": "add", "path_mm": [[0.1, 0.2, 0.3]],
     "radius_mm": 4}]}, {"name": "spleen", "file": "/s.dcm", "segment": 2}],
    "modes": [{"type": "surface", "structure": "liver", "strength_n": 1}]})",
                                "scene");
  ASSERT_EQ(scene.structures[0].edits.size(), 1U);
  EXPECT_TRUE(scene.structures[1].edits.empty());
  scene.structures[1].edits = {trace, io::RemoveEdit{{.path_mm = {trace.points_mm[3]}, .radius_mm = 1.0 / 3}}};
  const std::string text = to_json(scene);
  const Scene again = scene_from_json(text, "again");
  for (const std::size_t n : {0U, 1U}) EXPECT_EQ(again.structures[n].edits, scene.structures[n].edits);
  EXPECT_EQ(to_json(again), text);
  const auto refused = [](const std::string& edits) {
    return testing::said_when([&] {
      scene_from_json(R"({"version": 1, "modes": [], "structures": [
        {"name": "liver", "file": "/l.dcm", "segment": 1, "edits": )" +
                          edits + "}]}",
                      "scene");
    });
  };
  EXPECT_EQ(refused(R"([{"type": "add", "path_mm": [[1, 2, 3]], "radius_mm": 1}, {"type": "smooth"}])"),
            "scene: structures[0].edits[1].type: there is no \"smooth\"; there are: trace, add, remove, scan_edge, "
            "contours");
  EXPECT_EQ(refused("{}"), "scene: structures[0].edits: is not a list");
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
  // Too large for a whole number, though its lowest bits are those of 1.
  for (const std::string version : {"4294967297", "-4294967295", "9223372036854775809"}) {
    EXPECT_EQ(refusal_of_edits(R"({"edits": [], "version": )" + version + "}"),
              "mend.json: version: " + version + " is not a whole number");
  }
}

/// What is not there, and what is there and is a folder.
TEST(EditText, AFileThatCannotBeReadIsNamed) {
  const io::FreshFolder folder = io::temporary_folder();
  for (const std::string& path : {std::string("/no/such.json"), std::string("/"), std::string("."),
                                  folder.path().string(), (folder.path() / "none.json").string()}) {
    EXPECT_EQ(testing::said_when([&] { load_edits(path); }), path + ": no such file of edits can be read");
  }
}

TEST(EditText, AStructureWithoutAFileIsDrawnByItsContours) {
  const auto text_of = [](const std::string& more) {
    return R"({"version": 1, "modes": [], "structures": [{"name": "new")" + more + "}]}";
  };
  const std::string contours = R"("edits": [{"type": "contours", "loops_mm": [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]},
    {"type": "add", "path_mm": [[1, 2, 3]], "radius_mm": 1}])";
  const Scene scene = scene_from_json(text_of(", " + contours), "scene");
  EXPECT_TRUE(is_drawn(scene.structures[0]));
  EXPECT_EQ(scene.structures[0].edits.size(), 2U);
  const std::string text = to_json(scene);
  EXPECT_EQ(text.find("\"file\""), std::string::npos);
  EXPECT_EQ(to_json(scene_from_json(text, "again")), text);
  const auto refused = [&](const std::string& more) {
    return testing::said_when([&] { scene_from_json(text_of(more), "scene"); });
  };
  EXPECT_EQ(refused(""), "scene: structures[0].file: is missing");
  EXPECT_EQ(refused(R"(, "edits": [{"type": "add", "path_mm": [[1, 2, 3]], "radius_mm": 1}])"),
            "scene: structures[0].file: is missing");
  EXPECT_EQ(refused(R"(, "segment": 2, )" + contours),
            "scene: structures[0].segment: has no meaning without a file: leave it out, or name the file");
}

}  // namespace
}  // namespace palpate::modes
