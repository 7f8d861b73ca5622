// Control characters in file names and texts never reach a terminal.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "io/testing/test_image.h"
#include "plugin/testing/command_rig.h"
#include "plugin/testing/registered_study.h"
#include "solver/text/printable.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using testing::fresh_path;
using testing::Outcome;
using testing::palpate;

const std::string red = "\x1b[31m";
const std::string csi = "\xC2\x9B\x33\x31m";
const std::string bell = "\a";
const std::string erase = "\x7f";

/// The output, which has to hold no control character but the end of a line.
std::string checked(const std::string& arguments) {
  const std::string output = palpate(arguments).output;
  for (std::size_t n = 0; n < output.size(); ++n) {
    const auto byte = static_cast<unsigned char>(output[n]);
    const bool is_c1 = byte == 0xC2 && n + 1 < output.size() && static_cast<unsigned char>(output[n + 1]) < 0xA0;
    EXPECT_FALSE((byte < 0x20 && byte != '\n') || byte == 0x7F || is_c1) << arguments << ": byte " << n << " of\n"
                                                                         << printable(output);
  }
  return output;
}

/// A scan whose description and whose folder's name would change a terminal's colors, and a file beside it.
fs::path hostile_folder() {
  const fs::path folder = fresh_path("out\x1b[31mput");
  fs::create_directories(folder);
  io::internal::write_stack(folder, 5, [](int k, io::internal::TestImage& image) {
    image.columns = image.rows = 16;
    image.value = [k](int i, int j) { return (i > 5 && i < 11 && j > 5 && j < 11 ? 1000 : 0) + k; };
    image.edit = [](DcmDataset& d) {
      io::internal::put(d, DCM_SeriesDescription, fmt::format("{}red{}", red, bell));
      io::internal::put(d, DCM_PatientName, red + "name" + erase);
      io::internal::put(d, DCM_ConvolutionKernel, "B30" + red);
    };
  });
  std::ofstream(folder / (red + csi + bell + erase + ".txt")) << "no image";
  return folder;
}

std::string shell_word(const fs::path& path) {
  return fmt::format("'{}'", path.string());
}

TEST(Output, ControlCharactersAreShownByEveryCommand) {
  const std::string folder = shell_word(hostile_folder());
  const std::string info = checked("info --all --patient " + folder);
  EXPECT_NE(info.find("\\x1b[31mred\\x07"), std::string::npos) << info;
  EXPECT_NE(info.find("\\x1b[31m\\x9b31m\\x07\\x7f.txt: not a DICOM file"), std::string::npos) << info;
  checked("structures " + folder);
  checked("sample " + folder + " --at 1,1,1");
  checked("suggest " + folder);
  checked("plan " + folder + " --scene " + shell_word("no" + red + "scene.json"));
  checked("profile " + folder + " --from 0,0,4 --to 4,4,4");
  checked("profile " + folder + " --series " + shell_word(red) + " --from 0,0,4 --to 4,4,4");
  checked("replay " + shell_word("/absent/" + red + ".h5") + " " + folder);
  checked(shell_word(red));
  checked("info " + shell_word("--" + red));
  checked("info " + shell_word("/absent/" + csi + red));
  checked("find --archive " + shell_word(red));
}

// JSON has its own way to write them, and stays JSON.
TEST(Output, ControlCharactersInJsonAreWrittenAsJsonWritesThem) {
  const fs::path folder = hostile_folder();
  const std::string output = checked("info --json " + shell_word(folder));
  const auto json = nlohmann::json::parse(output);
  EXPECT_EQ(json.at("series").at(0).at("description"), fmt::format("{}red{}", red, bell));
  EXPECT_EQ(fs::path(json.at("skipped").at(0).at("path").get<std::string>()).filename().string(),
            red + csi + bell + erase + ".txt");
}

// Each command prints by put() and tell(), which do it.
TEST(Output, NoCommandPrintsPastIt) {
  const fs::path folder = fs::path(PALPATE_SOURCES) / "plugin/cli";
  const std::regex past(R"((fmt::print\((?!stderr)|std::printf|std::cout|std::fputs|std::puts\((?!")))");
  std::size_t looked_at = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() != ".cpp" || name.ends_with("_test.cpp")) continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      EXPECT_FALSE(std::regex_search(line, past)) << name << ": " << line;
    }
    ++looked_at;
  }
  EXPECT_GT(looked_at, 15U);
}

// Of values that no scanner gives there is little to tell; each command says so, and none ends by a fault of its own.
TEST(CommandOutput, ValuesOfAnySlopeAreNoInternalFault) {
  for (const char* const modality : {"CT", "MR"}) {
    for (const char* const slope : {"1e-300", "1e12", "-1e30", "1e36", "1e306"}) {
      const fs::path folder = fresh_path("slope");
      fs::create_directories(folder);
      io::internal::write_stack(folder, 12, [&](int k, io::internal::TestImage& image) {
        image.columns = image.rows = 24;
        image.value = [k](int i, int j) {
          return (std::hypot(i - 12, j - 12) < 7 && k > 2 && k < 9 ? 1000 : 40) + (7 * i + 5 * j + 3 * k) % 11;
        };
        image.edit = [&](DcmDataset& d) {
          io::internal::put(d, DCM_Modality, modality);
          io::internal::put(d, DCM_RescaleSlope, std::string(slope));
          io::internal::put(d, DCM_RescaleIntercept, std::string("0"));
        };
      });
      const std::string scan = folder.string(), scene = (folder / "scene.json").string();
      for (const std::string& command :
           {"info " + scan, "sample " + scan + " --at 6,4,8", "suggest " + scan + " -o " + scene, "plan " + scan,
            "profile " + scan + " --from 0,4,8 --to 6,4,8 --scene " + scene + " -o " + (folder / "a.png").string(),
            "profile " + scan + " --from 0,4,8 --to 6,4,8"}) {
        const Outcome outcome = palpate(command);
        EXPECT_LT(outcome.exit, 2) << modality << ", slope " << slope << ": " << command << "\n" << outcome.output;
      }
    }
  }
}

// A script that reads what the program says stops at bytes that are no UTF-8. Letters of Latin-1, which some write
// where the standard has no place for them, are letters.
TEST(CommandOutput, WhateverAttributesHoldItIsUtf8) {
  const fs::path folder = fresh_path("letters");
  fs::create_directories(folder);
  io::internal::write_stack(folder, 5, [](int, io::internal::TestImage& image) {
    image.edit = [](DcmDataset& d) {
      for (const DcmTagKey& tag : {DCM_Modality, DCM_BodyPartExamined, DCM_SeriesDescription, DCM_PatientName,
                                   DCM_PatientID, DCM_ConvolutionKernel, DCM_SequenceName, DCM_ContrastBolusAgent,
                                   DCM_StudyDate, DCM_SeriesTime, DCM_ImageType, DCM_LossyImageCompression}) {
        io::internal::succeed(d.putAndInsertString(tag,
                                                   "SCH\xC4"
                                                   "DEL"));
      }
    };
  });
  testing::write_contours(folder / "rt.dcm", "1.2", "7\xFC", "M\xFCller");
  DcmFileFormat contours;
  io::internal::succeed(contours.loadFile((folder / "rt.dcm").c_str()));
  DcmItem *roi = nullptr, *contour = nullptr;
  io::internal::succeed(contours.getDataset()->findAndGetSequenceItem(DCM_ROIContourSequence, roi));
  for (signed long n = 0; roi->findAndGetSequenceItem(DCM_ContourSequence, contour, n).good(); ++n) {
    io::internal::succeed(contour->putAndInsertString(DCM_ContourGeometricType, "CLOSED_PL\xC1NAR"));
  }
  io::internal::succeed(contours.saveFile((folder / "rt.dcm").c_str()));
  std::ofstream(folder / "a.nrrd")
      << "NRRD0004\ntype: short\ndimension: 3\nsizes: 2 2 2\nencoding: l\xFC\n"
         "space: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n\n";
  for (const char* const command : {"info ", "info --all ", "info --json ", "structures ", "structures --json "}) {
    const std::string output = palpate(command + folder.string()).output;
    EXPECT_EQ(printable(output), output) << command;
  }
  const std::string outlines = palpate("structures --json " + folder.string(), false).output;
  EXPECT_NE(outlines.find("7 CLOSED_PL\u00c1NAR"), std::string::npos) << outlines;
  const auto told = nlohmann::json::parse(palpate("info --json " + folder.string(), false).output).at("series").at(0);
  for (const char* const key : {"modality", "body_part", "description", "kernel"}) {
    EXPECT_EQ(told.at(key), "SCH\u00c4DEL") << key;
  }
}

}  // namespace
}  // namespace palpate::plugin
