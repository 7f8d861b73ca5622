// Structures as a script uses them, on a scan and a label map made here: the checks of SharedCommandStructures on real
// organs, for checkouts without the shared data.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "plugin/testing/command_rig.h"
#include "plugin/testing/kept_out.h"
#include "plugin/testing/registered_study.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::forehead;
using testing::fresh_path;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::palpate;
using testing::phantom;

constexpr int lattice = 60;
constexpr double ball_radius_mm = 10;

/// Of a voxel of the phantom's lattice, 1 mm apart about the origin.
double at_mm(int index) {
  return index - 0.5 * (lattice - 1);
}

/// A ball of 10 mm about the origin as label 1, in front of it a bar as label 2.
struct Labels {
  std::string bytes;
  int in_ball = 0;
};

Labels labels() {
  Labels made;
  for (int k = 0; k < lattice; ++k) {
    for (int j = 0; j < lattice; ++j) {
      for (int i = 0; i < lattice; ++i) {
        const bool ball = glm::length(glm::dvec3(at_mm(i), at_mm(j), at_mm(k))) < ball_radius_mm;
        const bool bar = j < 8 && std::abs(at_mm(i)) < 3;
        made.bytes += ball ? '\1' : bar ? '\2' : '\0';
        made.in_ball += ball ? 1 : 0;
      }
    }
  }
  return made;
}

fs::path folder_of_labels() {
  const fs::path folder = fresh_path("made_labels");
  fs::create_directories(folder);
  std::ofstream(folder / "labels.mha") << "NDims = 3\nDimSize = 60 60 60\nElementType = MET_UCHAR\n"
                                       << "Offset = -29.5 -29.5 -29.5\nElementDataFile = LOCAL\n"
                                       << labels().bytes;
  return folder;
}

/// A scene beside the labels, which names the ball and the bar.
fs::path scene_in(const fs::path& folder, const std::string& modes, const std::string& segment = "1") {
  std::ofstream(folder / "scene.json") << R"({"version": 1, "structures": [
    {"name": "ball", "file": "labels.mha", "segment": )"
                                       << segment << R"(}, {"name": "bar", "file": "labels.mha", "segment": 2}],
    "modes": [)" << modes << "]}";
  return folder / "scene.json";
}

const std::string ball_edge = R"({"type": "surface", "structure": "ball", "strength_n": 1})";

TEST(MadeStructures, AreListedWithTheirSizes) {
  const Outcome outcome = palpate("structures --json " + folder_of_labels().string(), false);
  ASSERT_EQ(outcome.exit, 0);
  const Json found = Json::parse(outcome.output).at("structures");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].at("number"), 1);
  EXPECT_EQ(found[0].at("voxels"), labels().in_ball);
  EXPECT_NEAR(found[0].at("volume_mm3").get<double>(), labels().in_ball, 1e-6);
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(found[0].at("centroid_mm").at(axis).get<double>(), 0, 1e-6);
}

TEST(MadeStructures, AreFeltAtTheirEdge) {
  const fs::path scene = scene_in(folder_of_labels(), ball_edge);
  const Outcome outcome =
      palpate("profile --json " + phantom().string() + forehead + "--scene " + scene.string(), false);
  ASSERT_EQ(outcome.exit, 0);
  const Json stroke = Json::parse(outcome.output);
  const Json& distances = stroke.at("distance_mm").at("ball");
  EXPECT_FALSE(stroke.at("distance_mm").contains("bar"));
  double most = 0;
  for (std::size_t n = 0; n < distances.size(); ++n) {
    const glm::dvec3 at(stroke.at("proxy_mm").at(n).at(0), stroke.at("proxy_mm").at(n).at(1),
                        stroke.at("proxy_mm").at(n).at(2));
    const glm::dvec3 force(stroke.at("force_n").at(n).at(0), stroke.at("force_n").at(n).at(1),
                           stroke.at("force_n").at(n).at(2));
    const double inside_mm = ball_radius_mm - glm::length(at);
    if (std::abs(inside_mm) < 5) {
      EXPECT_NEAR(distances[n].get<double>(), inside_mm, 0.5) << at.y;
    }
    if (inside_mm < -0.5) {
      EXPECT_LT(glm::length(force), 1e-6) << at.y;
    }
    most = std::max(most, glm::length(force));
  }
  EXPECT_NEAR(most, 1, 0.01);
}

// Into the margin of what is to be kept out of.
TEST(MadeStructures, AKeepOutIsRecordedAndRepeatedToTheLastBit) {
  const fs::path folder = folder_of_labels();
  const fs::path scene =
      scene_in(folder, R"({"type": "keep_out", "structure": "ball", "margin_mm": 3, "strength_n": 1})");
  const fs::path out = fresh_path("made_out");
  ASSERT_EQ(palpate("probe " + phantom().string() + " --from 0,-29,0 --to 0,25,0 --scene " + scene.string() + " -o " +
                    out.string())
                .exit,
            0);
  const auto [deepest_mm, most_n] = testing::kept_out_of("ball", read_recording(out / "recording.h5"));
  EXPECT_GT(deepest_mm, -3);
  EXPECT_LT(deepest_mm, 0);
  EXPECT_GT(most_n, 0.5);
  EXPECT_LE(most_n, 1 + 1e-9);
  EXPECT_THAT(testing::text_in(out / "summary.txt"), HasSubstr("mm from ball, at "));
  testing::expect_repeated_with_moved(folder / "labels.mha", "ball", out / "recording.h5", phantom().string());
}

TEST(MadeStructures, AreLeftOutWhereNoModeReadsThem) {
  const Outcome outcome =
      palpate("plan --json " + phantom().string() + " --scene " + scene_in(folder_of_labels(), ball_edge).string());
  EXPECT_THAT(outcome.output, HasSubstr(R"(structure \"bar\")"));
  EXPECT_THAT(outcome.output, ::testing::Not(HasSubstr(R"(structure \"ball\")")));
}

TEST(MadeStructures, OfASceneAreRefusedInWords) {
  const fs::path unknown = scene_in(folder_of_labels(), ball_edge, "\"spleen\"");
  const Outcome outcome = palpate("profile " + phantom().string() + forehead + "--scene " + unknown.string());
  EXPECT_EQ(outcome.exit, 1);
  EXPECT_THAT(outcome.output, HasSubstr("structure \"ball\": labels.mha has no \"spleen\"; there are: "));
}

TEST(MadeStructures, AreOfferedWithWhatIsSuggested) {
  const fs::path folder = folder_of_labels();
  testing::write_contours(folder / "rt.dcm", "1.2", "7", "Doe^Jane");  // of another patient
  const fs::path scene = folder / "suggested.json";
  const Outcome words =
      palpate("suggest " + phantom().string() + " --structures " + folder.string() + " -o " + scene.string(), false);
  ASSERT_EQ(words.exit, 0);
  const Json offered = Json::parse(testing::text_in(scene)).at("structures");
  ASSERT_EQ(offered.size(), 2U);
  EXPECT_EQ(offered[0].at("segment"), 1);
  EXPECT_EQ(offered[0].at("file"), (folder / "labels.mha").string());
  for (const Json& one : offered) {
    EXPECT_THAT(words.output,
                HasSubstr(fmt::format("  {:<36} label map, labels.mha\n", one.at("name").get<std::string>())));
  }
  EXPECT_THAT(words.output, HasSubstr(fmt::format("  {:<36} cannot be felt: ", "Cube")));
  EXPECT_THAT(words.output, HasSubstr(R"(  one is felt where a mode names it: {"type":"surface","structure":)" +
                                      offered[0].at("name").dump() + R"(,"strength_n":1})"));
}

}  // namespace
}  // namespace palpate::plugin
