// A scan that is not DICOM, through the whole program: info, sample, suggest, profile, record, replay. Its lattice is
// oblique and left-handed, and its values encode the position.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "plugin/testing/command_rig.h"
#include "plugin/testing/expect_near.h"

namespace palpate::plugin {
namespace {

using Json = nlohmann::json;
using testing::expect_near;
using testing::fresh_path;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::palpate;

constexpr int size = 64;
constexpr double radius_mm = 22;
const glm::dvec3 center(12, -7, 30);  // LPS, mm
const glm::dvec3 spacing(1.0, 0.9, 1.1);

/// Directions along the file's axes, LPS: turned about z, then about x; the first one points to the right.
std::array<glm::dvec3, 3> axes() {
  const double a = 0.35, b = 0.17;
  return {glm::dvec3(-std::cos(a), -std::sin(a), 0),
          glm::dvec3(-std::sin(a) * std::cos(b), std::cos(a) * std::cos(b), std::sin(b)),
          glm::dvec3(std::sin(a) * std::sin(b), -std::cos(a) * std::sin(b), std::cos(b))};
}

glm::dvec3 place_of(const glm::ivec3& voxel) {
  const auto along = axes();
  glm::dvec3 place = center;
  for (int n = 0; n < 3; ++n) {
    place += (voxel[n] - (size - 1) / 2.0) * spacing[n] * along[static_cast<std::size_t>(n)];
  }
  return place;
}

/// A ball.
double value_at(const glm::dvec3& place) {
  return glm::distance(place, center) > radius_mm ? 0 : std::round(600 + 4 * place.x + 2 * place.y + 3 * place.z);
}

std::string voxels() {
  std::string bytes;
  for (int n = 0; n < size * size * size; ++n) {
    const auto value = static_cast<std::int16_t>(value_at(place_of({n % size, n / size % size, n / (size * size)})));
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return bytes;
}

/// NIfTI-1 (nifti1.h) with an sform, in RAS.
std::string nifti() {
  std::string header(352, '\0');
  const auto put = [&](std::size_t at, auto number) { std::memcpy(header.data() + at, &number, sizeof number); };
  put(0, std::int32_t{348});
  const std::array<std::int16_t, 5> sizes{3, size, size, size, 1};
  for (std::size_t n = 0; n < sizes.size(); ++n) put(40 + 2 * n, sizes[n]);
  put(70, std::int16_t{4});
  put(72, std::int16_t{16});
  put(76, 1.0F);
  for (int n = 0; n < 3; ++n) put(80 + 4 * static_cast<std::size_t>(n), static_cast<float>(spacing[n]));
  put(108, 352.0F);
  put(123, std::uint8_t{2});
  put(254, std::int16_t{1});
  const glm::dvec3 first = place_of({0, 0, 0});
  for (int row = 0; row < 3; ++row) {
    const double ras = row < 2 ? -1 : 1;
    const std::size_t at = 280 + 16 * static_cast<std::size_t>(row);
    for (std::size_t n = 0; n < 3; ++n) {
      put(at + 4 * n, static_cast<float>(ras * spacing[static_cast<int>(n)] * axes()[n][row]));
    }
    put(at + 12, static_cast<float>(ras * first[row]));
  }
  std::memcpy(header.data() + 344, "n+1", 3);
  return header + voxels();
}

std::string in_brackets(const glm::dvec3& v) {
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "(%.17g,%.17g,%.17g)", v.x, v.y, v.z);
  return text.data();
}

std::string nrrd() {
  const auto along = axes();
  std::string header =
      "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 64 64 64\n"
      "endian: little\nencoding: raw\nspace directions:";
  for (int n = 0; n < 3; ++n) {
    header += ' ';
    header += in_brackets(spacing[n] * along[static_cast<std::size_t>(n)]);
  }
  return header + "\nspace origin: " + in_brackets(place_of({0, 0, 0})) + "\n\n" + voxels();
}

std::string as_argument(const glm::dvec3& v) {
  const std::string text = in_brackets(v);
  return text.substr(1, text.size() - 2);
}

void expect_the_lattice(const std::string& file) {
  const Json series = Json::parse(palpate("info --json " + file, false).output).at("series").at(0);
  EXPECT_EQ(series.at("dimensions"), Json({size, size, size}));
  EXPECT_EQ(series.at("usable"), true);
  expect_near(series.at("spacing_mm"), Json({1.0, 0.9, 1.1}), 1e-5, "spacing_mm");
  const auto along = axes();
  expect_near(series.at("direction_i"), Json({along[0].x, along[0].y, along[0].z}), 1e-5, "direction_i");
  expect_near(series.at("direction_j"), Json({along[1].x, along[1].y, along[1].z}), 1e-5, "direction_j");
  // Left-handed: what the file has last comes first, so that slices ascend along i x j.
  const glm::dvec3 first = place_of({0, 0, size - 1}), step = -spacing.z * along[2];
  expect_near(series.at("origin_mm"), Json({first.x, first.y, first.z}), 1e-4, "origin_mm");
  expect_near(series.at("step_mm"), Json({step.x, step.y, step.z}), 1e-5, "step_mm");
}

void expect_the_values(const std::string& file) {
  std::string points;
  std::vector<double> values;
  for (int n = 0; n < 40; ++n) {
    const glm::dvec3 place = place_of({13 * n % size, (7 * n + 20) % size, (29 * n + 9) % size});
    points.append(" ").append(as_argument(place));
    values.push_back(value_at(place));
  }
  const Json samples = Json::parse(palpate("sample --json " + file + " --at" + points, false).output);
  ASSERT_EQ(samples.size(), values.size());
  int inside = 0;
  for (std::size_t n = 0; n < values.size(); ++n) {
    // The outermost voxels' centers may be outside by a rounding.
    if (!samples[n].contains("value")) continue;
    EXPECT_NEAR(samples[n].at("value").get<double>(), values[n], 0.05) << samples[n];
    inside += values[n] > 0 ? 1 : 0;
  }
  EXPECT_GT(inside, 3);
}

class CommandInterchange : public ::testing::TestWithParam<const char*> {};

TEST_P(CommandInterchange, IsDescribedSuggestedFeltRecordedAndReplayed) {
  const auto folder = fresh_path("interchange");
  std::filesystem::create_directory(folder);
  const std::string file = (folder / GetParam()).string();
  std::ofstream(file, std::ios::binary) << (file.ends_with(".nii") ? nifti() : nrrd());
  expect_the_lattice(file);
  expect_the_values(file);

  const std::string scene = (folder / "scene.json").string();
  const Outcome suggested = palpate("suggest " + file + " -o " + scene);
  ASSERT_EQ(suggested.exit, 0) << suggested.output;
  // From the patient's front to the ball's center: the first force is at its edge, and against the stroke.
  const std::string stroke = " --from " + as_argument(center - glm::dvec3(0, radius_mm + 6, 0)) + " --to " +
                             as_argument(center) + " --scene " + scene;
  const Json profile = Json::parse(palpate("profile --json " + file + stroke, false).output);
  std::size_t first = 0;
  while (first < profile.at("force_n").size() && profile["force_n"][first][1].get<double>() > -0.03) ++first;
  ASSERT_LT(first, profile["force_n"].size()) << "something is felt";
  EXPECT_NEAR(profile["position_mm"][first][1].get<double>(), center.y - radius_mm, 0.4);

  const std::string recording = (folder / "session.h5").string();
  const Outcome recorded = palpate("record " + file + stroke + " --seconds 3 -o " + recording);
  ASSERT_EQ(recorded.exit, 0) << recorded.output;
  const Outcome replayed = palpate("replay " + recording + " " + file);
  EXPECT_EQ(replayed.exit, 0) << replayed.output;
  EXPECT_THAT(replayed.output, HasSubstr("the same to the last bit"));
}

INSTANTIATE_TEST_SUITE_P(Files, CommandInterchange, ::testing::Values("ball.nii", "ball.nrrd"),
                         [](const auto& file) { return std::string(file.param).substr(5); });

}  // namespace
}  // namespace palpate::plugin
