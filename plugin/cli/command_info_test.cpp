// `palpate info` and `sample` as a script uses them, on series with known numbers.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"
#include "plugin/testing/command_rig.h"
#include "plugin/testing/expect_near.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using testing::expect_near;
using testing::fresh_path;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;
using testing::palpate;

/// A phantom on a grid that is oblique, tilted and not square, written as DICOM: every number that is asked for is
/// known from the grid and the scan.
struct Known {
  io::Volume volume;
  fs::path folder;
};
Known known_series(const char* name, const testdata::SeriesLabel& label = {}) {
  testdata::Grid grid;
  grid.size = {20, 18, 12};
  grid.spacing = {0.8, 0.6, 1.5};
  grid.center = {12, -34, 56};
  grid.tilt_degrees = 10;
  grid = testdata::rotated(grid, glm::normalize(glm::dvec3(1, 2, 3)), 25);
  Known known{testdata::scan(testdata::make_sphere(60), testdata::make_geometry(grid), {.noise = 20}),
              fresh_path(name)};
  testdata::write_series(known.volume, known.folder, label);
  return known;
}

std::vector<double> numbers(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}

TEST(CommandInfo, SaysWhatTheGridIs) {
  testdata::SeriesLabel label;
  label.description = "oblique ball";
  const Known known = known_series("known", label);
  const io::Geometry& g = known.volume.geometry;
  const Outcome outcome = palpate("info --json " + known.folder.string(), false);
  ASSERT_EQ(outcome.exit, 0);
  const Json all = Json::parse(outcome.output);
  EXPECT_TRUE(all.at("skipped").empty());
  ASSERT_EQ(all.at("series").size(), 1U);
  const Json& s = all.at("series").at(0);
  EXPECT_EQ(s.at("modality"), "CT");
  EXPECT_EQ(s.at("description"), "oblique ball");
  EXPECT_EQ(s.at("files"), 12);
  EXPECT_EQ(s.at("dimensions"), Json({20, 18, 12}));
  EXPECT_EQ(s.at("unit"), "HU");
  EXPECT_EQ(s.at("uniform"), true);
  EXPECT_EQ(s.at("usable"), true);
  expect_near(s.at("origin_mm"), numbers(g.slice_positions.front()), 1e-6, "origin_mm");
  expect_near(s.at("direction_i"), numbers(g.direction_i), 1e-6, "direction_i");
  expect_near(s.at("direction_j"), numbers(g.direction_j), 1e-6, "direction_j");
  expect_near(s.at("step_mm"), numbers(g.step), 1e-6, "step_mm");
  // Between slices along their normal: less than the step of a tilted gantry is long.
  const double apart = glm::dot(g.step, glm::normalize(glm::cross(g.direction_i, g.direction_j)));
  EXPECT_LT(apart, 0.99 * glm::length(g.step));
  expect_near(s.at("spacing_mm"), Json({0.8, 0.6, apart}), 1e-5, "spacing_mm");
  double least = 1e9, most = -1e9, sum = 0;
  for (int k = 0; k < 12; ++k) {
    for (int j = 0; j < 18; ++j) {
      for (int i = 0; i < 20; ++i) {
        const double value = known.volume.value_at(i, j, k);
        least = std::min(least, value);
        most = std::max(most, value);
        sum += value;
      }
    }
  }
  EXPECT_EQ(s.at("minimum"), least);
  EXPECT_EQ(s.at("maximum"), most);
  EXPECT_NEAR(s.at("mean"), sum / (20 * 18 * 12), 1e-6);
}

TEST(CommandSample, GivesTheVoxelAtItsCenterAndSaysWhatIsOutside) {
  const Known known = known_series("sampled");
  const io::Geometry& g = known.volume.geometry;
  std::string points;
  std::vector<double> values;
  for (int n = 0; n < 40; ++n) {
    const glm::ivec3 at(7 * n % 20, 5 * n % 18, 11 * n % 12);
    const glm::dvec3 p = g.slice_positions[static_cast<std::size_t>(at.z)] + (at.x * g.spacing_i) * g.direction_i +
                         (at.y * g.spacing_j) * g.direction_j;
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), " %.6f,%.6f,%.6f", p.x, p.y, p.z);
    points += text.data();
    values.push_back(known.volume.value_at(at.x, at.y, at.z));
  }
  const Outcome outcome = palpate("sample --json " + known.folder.string() + " --at" + points, false);
  ASSERT_EQ(outcome.exit, 0);
  const Json samples = Json::parse(outcome.output);
  ASSERT_EQ(samples.size(), values.size());
  for (std::size_t n = 0; n < values.size(); ++n) {
    EXPECT_NEAR(samples[n].value("value", std::nan("")), values[n], 0.05) << n << " " << samples[n];
    EXPECT_EQ(samples[n].at("gradient_per_mm").size(), 3U);
  }
  const Outcome outside = palpate("sample --json " + known.folder.string() + " --at 0,0,5000", false);
  EXPECT_EQ(Json::parse(outside.output), Json::parse(R"([{"position_mm": [0.0, 0.0, 5000.0], "outside": true}])"));
}

// As its help says: a quarter of the way to the next voxel three quarters of the one and a quarter of the other.
TEST(CommandSample, InterpolatesAsItsHelpSays) {
  const std::string help = std::regex_replace(palpate("sample --help").output, std::regex("\\s+"), " ");  // wrapped
  EXPECT_THAT(help, HasSubstr("linearly between the eight voxels"));
  const Known known = known_series("between");
  const io::Geometry& g = known.volume.geometry;
  for (int n = 0; n < 6; ++n) {
    const glm::ivec3 at(1 + 3 * n % 17, 1 + 5 * n % 15, 1 + 2 * n % 10);  // a place on the border may round to outside
    const glm::ivec3 next = at + glm::ivec3(n % 2, 1 - n % 2, 0);
    const glm::dvec2 part = glm::dvec2(at) + 0.25 * glm::dvec2(next - at);
    const glm::dvec3 p = g.slice_positions[static_cast<std::size_t>(at.z)] + (part.x * g.spacing_i) * g.direction_i +
                         (part.y * g.spacing_j) * g.direction_j;
    const std::string command =
        fmt::format("sample --json {} --at={:.9g},{:.9g},{:.9g}", known.folder.string(), p.x, p.y, p.z);
    const double value = Json::parse(palpate(command, false).output).at(0).at("value");
    EXPECT_NEAR(value,
                0.75 * known.volume.value_at(at.x, at.y, at.z) + 0.25 * known.volume.value_at(next.x, next.y, next.z),
                0.05);
  }
}

TEST(SeriesOption, SeveralSeriesAreToldApartAndNoneChosenIsWrongUsage) {
  const fs::path both = fresh_path("both");
  fs::create_directory(both);
  testdata::SeriesLabel first, second;
  first.description = "THIN";
  first.number = 3;
  second.description = "THICK";
  second.number = 4;
  const Known thin = known_series("both/thin", first), thick = known_series("both/thick", second);
  const glm::dvec3 middle = thin.volume.geometry.to_patient({10, 9, 6});
  std::array<char, 128> at{};
  std::snprintf(at.data(), at.size(), " --at %.6f,%.6f,%.6f ", middle.x, middle.y, middle.z);
  const std::string sample = "sample " + both.string() + at.data();
  const Outcome none = palpate(sample);
  EXPECT_EQ(none.exit, 2);
  EXPECT_THAT(none.output, ::testing::AllOf(HasSubstr("holds 2 series"), HasSubstr("THIN"), HasSubstr("THICK")));
  EXPECT_EQ(palpate(sample + "--series 1").exit, 0);
  EXPECT_EQ(palpate(sample + "--series 2").exit, 0);
  EXPECT_EQ(palpate(sample + "--series 99").exit, 2);
  EXPECT_EQ(palpate(sample + "--series 1.2.3").exit, 2);
  EXPECT_EQ(palpate(sample + "--series 1 --frame 1").exit, 2);
}

TEST(CommandInfo, ShowsWhoseScanItIsOnRequestOnly) {
  testdata::SeriesLabel label;
  label.subject = "PLASTIC^HEAD";
  const fs::path scan = known_series("named", label).folder;
  EXPECT_THAT(palpate("info " + scan.string()).output, Not(HasSubstr("PLASTIC")));
  EXPECT_THAT(palpate("info --json " + scan.string()).output, Not(HasSubstr("PLASTIC")));
  EXPECT_THAT(palpate("info --patient " + scan.string()).output, HasSubstr("PLASTIC"));
}

/// Name, id and day of the study, each where it is said to be: by them a person checks that it is the right patient.
TEST(CommandInfo, NamesThePatientTheIdAndTheStudysDay) {
  const fs::path scan = fresh_path("whose");
  fs::create_directories(scan);
  io::internal::write_stack(scan, 5, [](int, io::internal::TestImage& image) {
    image.edit = [](DcmDataset& d) {
      io::internal::put(d, DCM_PatientName, "Plastic^Head");
      io::internal::put(d, DCM_PatientID, "P-77");
      io::internal::put(d, DCM_StudyDate, "20260104");
    };
  });
  EXPECT_THAT(palpate("info --patient " + scan.string()).output,
              ::testing::ContainsRegex("\n   patient Plastic.Head, id P-77, study of 2026-?01-?04\n"));
}

TEST(SeriesOption, NothingToUseIsRefusedWithAReason) {
  const fs::path folder = fresh_path("no_images");
  fs::create_directory(folder);
  std::ofstream(folder / "notes.txt") << "not an image";
  for (const std::string command : {"sample --at 0,0,0 ", "info "}) {
    EXPECT_EQ(palpate(command + folder.string()).exit, 1) << command;
    EXPECT_EQ(palpate(command + "/no/such/folder").exit, 1) << command;
  }
  EXPECT_EQ(palpate("sample " + folder.string() + " --at 1,2").exit, 2);
  EXPECT_EQ(palpate("sample " + folder.string() + " --at 1,2,x").exit, 2);
}

/// A study as a hospital sends it: a thick and a thin stack, and what is no image. Values 100 k + 10 i + j, padding 0.
fs::path written_study() {
  const fs::path study = fresh_path("study");
  for (const char* name : {"thick", "thin"}) {
    const bool is_thin = name == std::string("thin");
    fs::create_directories(study / name);
    io::internal::write_stack(study / name, is_thin ? 20 : 12, [&](int k, io::internal::TestImage& image) {
      image.z = (is_thin ? 1 : 5) * k;
      image.series = is_thin ? "1.2.3.5" : "1.2.3.4";
      image.edit = [=](DcmDataset& d) {
        using io::internal::put;
        put(d, DCM_SeriesNumber, is_thin ? "12" : "2");
        put(d, DCM_SeriesDate, "20260104");
        put(d, DCM_SeriesTime, "101500");
        put(d, DCM_BodyPartExamined, "CHEST");
        put(d, DCM_ConvolutionKernel, "B30f");
        put(d, DCM_SliceThickness, is_thin ? "1" : "5");
        put(d, DCM_PixelPaddingValue, 0);
        put(d, DCM_RescaleSlope, "1");
        put(d, DCM_RescaleIntercept, "-1000");
      };
    });
  }
  for (int n = 0; n < 15; ++n) {
    io::internal::TestImage report;
    report.series = "1.2.3.6";
    report.edit = [n](DcmDataset& d) {
      d.findAndDeleteElement(DCM_PixelData);
      io::internal::put(d, DCM_SOPClassUID,
                        n < 12   ? UID_EnhancedSRStorage
                        : n < 14 ? UID_SegmentationStorage
                                 : UID_XRayRadiationDoseSRStorage);
    };
    io::internal::write(report, study / ("report" + std::to_string(n)));
  }
  std::ofstream(study / "notes.txt") << "not an image";
  return study;
}

TEST(CommandInfo, TellsTheSeriesOfAStudyApartAndWhichToFeelFirst) {
  const Outcome outcome = palpate("info --json " + written_study().string(), false);
  ASSERT_EQ(outcome.exit, 0);
  const Json all = Json::parse(outcome.output);
  ASSERT_EQ(all.at("series").size(), 2U);
  for (const std::size_t n : {0U, 1U}) {
    const Json& s = all.at("series").at(n);
    EXPECT_EQ(s.at("number"), n == 0 ? 2 : 12);
    EXPECT_EQ(s.at("date"), "20260104");
    EXPECT_EQ(s.at("time"), "101500");
    EXPECT_EQ(s.at("body_part"), "CHEST");
    EXPECT_EQ(s.at("kernel"), "B30f");
    EXPECT_EQ(s.at("thickness_mm"), n == 0 ? 5 : 1);
    EXPECT_EQ(s.at("orientation"), "axial");
    EXPECT_EQ(s.at("first_choice"), n == 1);
    EXPECT_EQ(s.at("frames"), Json::parse(R"([{"index": 0, "label": ""}])"));
    // 24 voxels a slice of 10 i + j; the first voxel of the first slice is padding.
    const int slices = n == 0 ? 12 : 20;
    const double sum = 24 * 100.0 * slices * (slices - 1) / 2 + slices * (4 * 150 + 6 * 6);
    EXPECT_EQ(s.at("minimum_with_padding"), -1000);
    EXPECT_EQ(s.at("maximum_with_padding"), 100 * (slices - 1) + 53 - 1000);
    EXPECT_NEAR(s.at("mean_with_padding"), sum / (24 * slices) - 1000, 1e-9);
    EXPECT_EQ(s.at("minimum"), 1 - 1000);
    EXPECT_EQ(s.at("maximum"), 100 * (slices - 1) + 53 - 1000);
    EXPECT_NEAR(s.at("mean"), sum / (24 * slices - 1) - 1000, 1e-9);
  }
  EXPECT_EQ(all.at("skipped").size(), 16U);
  EXPECT_EQ(all.at("skipped_summary"), Json::parse(R"([{"kind": "structured report", "count": 12},
      {"kind": "segmentation", "count": 2}, {"kind": "dose report", "count": 1}, {"kind": "other file", "count": 1}])"));
}

/// Of a series that is padding alone there are values with it and none without it.
TEST(CommandInfo, PaddingAloneHasNoValues) {
  const fs::path folder = fresh_path("padding");
  fs::create_directories(folder);
  io::internal::write_stack(folder, 5, [](int, io::internal::TestImage& image) {
    image.value = [](int, int) { return 7; };
    image.edit = [](DcmDataset& d) {
      io::internal::put(d, DCM_PixelPaddingValue, 7);
      io::internal::put(d, DCM_RescaleSlope, "1");
      io::internal::put(d, DCM_RescaleIntercept, "-1000");
    };
  });
  const Json s = Json::parse(palpate("info --json " + folder.string(), false).output).at("series").at(0);
  for (const std::string key : {"minimum", "maximum", "mean"}) {
    EXPECT_TRUE(s.at(key).is_null()) << s.at(key);
    EXPECT_EQ(s.at(key + "_with_padding"), 7 - 1000) << key;
  }
  EXPECT_THAT(palpate("info " + folder.string(), false).output, Not(HasSubstr("values ")));
}

TEST(CommandInfo, SumsUpWhatIsSetApart) {
  const std::string study = written_study().string();
  const std::string text = palpate("info " + study, false).output;
  EXPECT_THAT(text, HasSubstr("\n   series 12, 20260104 at 101500, CHEST, axial, kernel B30f, 1 mm thick, 20 files\n"));
  EXPECT_THAT(text, HasSubstr("\nbest to feel first: 2 (slices every 1.00 mm, soft kernel B30f, 20 slices)\n"));
  const std::string kinds =
      "\nset apart: 12 structured reports, 2 segmentations (see palpate structures), 1 dose report, 1 other file";
  EXPECT_THAT(text, HasSubstr(kinds + "; --all names them\n"));
  EXPECT_THAT(text, Not(HasSubstr("notes.txt")));
  const std::string each = palpate("info --all " + study, false).output;
  EXPECT_THAT(each, HasSubstr(kinds + "\n"));
  EXPECT_THAT(each, HasSubstr("notes.txt: not a DICOM file\n"));
  EXPECT_THAT(each, HasSubstr("report14: "));
}

// None of its images can be decoded, which its headers do not show.
TEST(CommandInfo, SeriesThatCannotBeDecodedIsNotTheFirstChoice) {
  const fs::path both = fresh_path("undecodable");
  for (const char* name : {"good", "bad"}) {
    const bool is_good = name == std::string("good");
    fs::create_directories(both / name);
    io::internal::write_stack(both / name, 12, [&](int k, io::internal::TestImage& image) {
      image.z = (is_good ? 5 : 1) * k;
      image.series = is_good ? "1.2.3.4" : "1.2.3.5";
      if (!is_good) image.syntax = EXS_RLELossless;
      image.edit = [=](DcmDataset& d) {
        io::internal::put(d, DCM_SliceThickness, is_good ? "5" : "1");
        if (!is_good) io::internal::encapsulate(d, EXS_RLELossless, {std::vector<Uint8>(100, 7)}, 1U << 20);
      };
    });
  }
  const Json all = Json::parse(palpate("info --json " + both.string(), false).output);
  ASSERT_EQ(all.at("series").size(), 2U);
  for (const Json& s : all.at("series")) {
    const bool is_good = s.at("uid") == "1.2.3.4";
    EXPECT_EQ(s.at("usable"), is_good) << s;
    EXPECT_EQ(s.at("first_choice"), is_good) << s;
  }
}

/// One voxel that is no padding has a value that is told.
TEST(CommandInfo, TellsTheValueOfOneVoxelAlone) {
  const fs::path folder = fresh_path("one_voxel");
  fs::create_directories(folder);
  io::internal::write_stack(folder, 5, [](int k, io::internal::TestImage& image) {
    image.value = [k](int i, int j) { return k == 2 && i == 3 && j == 1 ? 9 : 7; };
    image.edit = [](DcmDataset& d) {
      io::internal::put(d, DCM_PixelPaddingValue, 7);
      io::internal::put(d, DCM_RescaleSlope, "1");
      io::internal::put(d, DCM_RescaleIntercept, "-1000");
    };
  });
  EXPECT_THAT(palpate("info " + folder.string(), false).output, HasSubstr("\n   values -991 to -991, mean -991"));
}

/// Every frame has its line, the last included, and what is found in decoding is told, too.
TEST(CommandInfo, NamesEveryFrameAndTheImagesThatCannotBeRead) {
  const fs::path folder = fresh_path("frames_and_failures");
  for (int phase = 0; phase < 3; ++phase) {
    testdata::write_series(
        testdata::scan(testdata::make_sphere(5 - phase), testdata::make_geometry({.size = glm::ivec3(10)})),
        folder / std::to_string(phase), {.study = "beating", .trigger_time_ms = 300.0 * phase});
  }
  const Json s = Json::parse(palpate("info --json " + folder.string(), false).output).at("series").at(0);
  const std::string text = palpate("info " + folder.string(), false).output;
  ASSERT_EQ(s.at("frames").size(), 3U);
  for (const Json& frame : s.at("frames")) {
    EXPECT_THAT(text, HasSubstr(fmt::format("\n   frame {}: {}\n", frame.at("index").get<int>(),
                                            frame.at("label").get<std::string>())));
  }
  const fs::path broken = fresh_path("one_broken");
  fs::create_directories(broken);
  io::internal::write_stack(broken, 12, [](int k, io::internal::TestImage& image) {
    if (k != 11) return;
    image.syntax = EXS_RLELossless;
    image.edit = [](DcmDataset& d) {
      io::internal::encapsulate(d, EXS_RLELossless, {std::vector<Uint8>(100, 7)}, 1U << 20);
    };
  });
  EXPECT_THAT(palpate("info " + broken.string(), false).output,
              ::testing::ContainsRegex("\n   note: [^\n]*" + io::internal::numbered("s", 11)));
}

}  // namespace
}  // namespace palpate::plugin
