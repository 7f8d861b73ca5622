// The same commands with a real Orthanc, if it is installed: from an empty folder to a report in the archive.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "io/archive/testing/orthanc.h"
#include "io/archive/testing/says.h"
#include "io/structures/label_image.h"
#include "io/testing/test_image.h"
#include "plugin/testing/command_archive_case.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin {
namespace {

using namespace testing;
using io::testing::says;
using ::testing::HasSubstr;
using Json = nlohmann::json;
namespace fs = std::filesystem;

class CommandOrthanc : public CommandArchive {
 protected:
  void SetUp() override {
    if (io::testing::orthanc_program().empty()) GTEST_SKIP() << "Orthanc is not installed: apt-get install orthanc";
    CommandArchive::SetUp();
    orthanc_ = std::make_unique<io::testing::Orthanc>(fresh_path("orthanc"));
    const io::Archive& there = orthanc_->archive();
    const std::string entered = "archive add here --host 127.0.0.1 --port " + std::to_string(there.port) +
                                " --called ORTHANC --calling PALPATE --listen-address 127.0.0.1 --listen " +
                                std::to_string(there.listen_port);
    ASSERT_EQ(run(entered).exit, 0);
    ASSERT_EQ(run(entered + " --get").exit, 0);
    ASSERT_EQ(run("archive remove here").exit, 0);
    ASSERT_EQ(run(entered).exit, 0);
    by_get_ = "archive add by-get " + entered.substr(std::string("archive add here ").size()) + " --get";
  }
  std::unique_ptr<io::testing::Orthanc> orthanc_;
  std::string by_get_;
};

TEST_F(CommandOrthanc, FromTheArchiveAndBack) {
  EXPECT_THAT(run("archive echo").output, HasSubstr("here answers and knows us as PALPATE"));
  EXPECT_EQ(json("archive echo --json")["answers"], true);
  EXPECT_THAT(run("find").output, HasSubstr("nothing found"));
  EXPECT_EQ(json("send " + phantom().string() + " --json")["sent"], 60);

  const Json found = json("find --modality CT --json");
  ASSERT_EQ(found["studies"].size(), 1U) << found;
  const std::string study = found["studies"][0]["study_uid"], series = found["studies"][0]["series"][0]["series_uid"];
  EXPECT_EQ(found["studies"][0]["series"][0]["images"], 60);

  // By C-MOVE into a folder of ours, by C-GET into the private one.
  const fs::path folder = fresh_path("fetched");
  const Json moved = json("fetch " + series + " -o " + folder.string() + " --json");
  EXPECT_EQ(moved["images"], 60);
  EXPECT_EQ(moved["complete"], true);
  ASSERT_EQ(run(by_get_).exit, 0);
  const Outcome got = run("fetch --archive by-get " + study);
  EXPECT_EQ(got.exit, 0) << got.output;
  EXPECT_TRUE(says(got.output, "palpate: what was fetched stays in {} until `palpate archive empty`"));
  const fs::path hidden = home_ / "cache/palpate/fetched";
  EXPECT_EQ(fs::status(hidden).permissions(), fs::perms::owner_all);
  EXPECT_EQ(json("archive list --json")["fetched"]["series"], 1);
  EXPECT_THAT(run("archive empty").output, HasSubstr("1 series deleted"));
  EXPECT_FALSE(fs::exists(hidden));

  // Felt, marked, sent back, and found there in the same study.
  const std::string fetched = moved["series"][0]["folder"];
  const fs::path out = fresh_path("results");
  const Outcome exported = run("export " + recorded(fetched).string() + " " + fetched + " -o " + out.string());
  ASSERT_EQ(exported.exit, 0) << exported.output;
  EXPECT_EQ(json("send --archive here " + out.string() + " --json")["sent"], 3);
  const Json after = json("find --archive here --json");
  ASSERT_EQ(after["studies"].size(), 1U) << after;
  EXPECT_EQ(after["studies"][0]["study_uid"], study);
  std::map<std::string, int> modalities;
  for (const Json& one : after["studies"][0]["series"]) modalities[one["modality"]] += one["images"].get<int>();
  EXPECT_EQ(modalities, (std::map<std::string, int>{{"CT", 60}, {"SR", 1}, {"OT", 2}}));

  const fs::path text = fresh_path("text");
  std::ofstream(text) << "not DICOM";
  const Outcome refused = run("send --archive here " + text.string());
  EXPECT_EQ(refused.exit, 1);
  EXPECT_TRUE(says(refused.output, "{} of {} files were not sent"));
}

/// What was outlined on a scan goes into the scan's study, is found there, and comes back as it was.
TEST_F(CommandOrthanc, OutlinesGoIntoTheStudyAndComeBack) {
  ASSERT_EQ(json("send " + phantom().string() + " --json")["sent"], 60);
  const io::Series scan = io::find_series(std::array{phantom()}).series.at(0);
  io::StructureLabel label;
  label.name = "Größe";
  label.type = {"10200004", "SCT", "Liver"};
  const auto outline = [](const io::Vec3& at) { return 20 - std::sqrt(at.x * at.x + at.y * at.y + at.z * at.z); };
  const fs::path out = fresh_path("outlines");
  fs::create_directories(out);
  for (const auto& [form, name] :
       {std::pair{io::StructureForm::segmentation, "seg.dcm"}, std::pair{io::StructureForm::contours, "rt.dcm"}}) {
    write_structure(label, scan, scan.geometry, outline, {}, form, out / name, {.software_version = "1"});
  }
  EXPECT_EQ(json("send --archive here " + out.string() + " --json")["sent"], 2);

  const Json found = json("find --archive here --json");
  ASSERT_EQ(found["studies"].size(), 1U) << found;
  std::map<std::string, std::string> series;
  for (const Json& one : found["studies"][0]["series"]) series[one["modality"]] = one["series_uid"];
  ASSERT_EQ(series.size(), 3U) << found;
  const fs::path back = fresh_path("outlines_back");
  ASSERT_EQ(
      json("fetch " + series.at("SEG") + " " + series.at("RTSTRUCT") + " -o " + back.string() + " --json")["images"],
      2);
  const Json sent = json("structures --json " + out.string()), fetched = json("structures --json " + back.string());
  ASSERT_EQ(fetched["structures"].size(), 2U) << fetched;
  std::set<std::string> kinds;
  for (const Json& one : fetched["structures"]) {
    kinds.insert(one["kind"]);
    EXPECT_EQ(one["name"], "Größe");
    const auto was = std::ranges::find_if(sent["structures"], [&](const Json& s) { return s["kind"] == one["kind"]; });
    ASSERT_NE(was, sent["structures"].end());
    for (const char* const key : {"volume_mm3", "centroid_mm", "box_mm", "frame_of_reference_uid"}) {
      EXPECT_EQ(one[key], (*was)[key]) << key;
    }
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"SEG", "RTSTRUCT"}));
}

/// A study of 1.5 MiB whose every text is another: each is told as what it is, in the text and in the JSON, and a MiB
/// is a MiB.
TEST_F(CommandOrthanc, TellsEachTextAndSizeAsWhatItIs) {
  const fs::path study = fresh_path("told_study");
  fs::create_directories(study);
  io::internal::write_stack(study, 12, [](int, io::internal::TestImage& image) {
    image.columns = image.rows = 256;
    image.edit = [](DcmDataset& d) {
      using io::internal::put;
      put(d, DCM_PatientName, "Plastic^Head");
      put(d, DCM_PatientID, "P-77");
      put(d, DCM_StudyDate, "20260104");
      put(d, DCM_StudyDescription, "PHANTOMS");
    };
  });
  ASSERT_EQ(json("send " + study.string() + " --json")["sent"], 12);
  const Json found = json("find --json")["studies"].at(0);
  const std::string uid = found["study_uid"];
  EXPECT_THAT(found["patient"].get<std::string>(), HasSubstr("Plastic"));
  EXPECT_EQ(found["patient_id"], "P-77");
  EXPECT_EQ(found["date"], "20260104");
  EXPECT_EQ(found["description"], "PHANTOMS");
  EXPECT_THAT(run("find").output, HasSubstr(found["patient"].get<std::string>() +
                                            "  P-77  20260104  \"PHANTOMS\"\n   study " + uid + "\n"));

  const fs::path folder = fresh_path("told_fetched");
  EXPECT_EQ(run("fetch " + uid + " --most-mib 1 -o " + folder.string()).exit, 1);
  EXPECT_EQ(json("fetch " + uid + " --most-mib 2 -o " + folder.string() + " --json")["images"], 12);
  ASSERT_EQ(run("fetch " + uid).exit, 0);
  EXPECT_EQ(json("archive list --json")["fetched"]["bytes"].get<std::size_t>() >> 20U, 1U);
  EXPECT_THAT(run("archive list").output, HasSubstr("1 series fetched and not deleted yet, 1 MiB, in "));
  EXPECT_THAT(run("archive empty").output, HasSubstr("1 series deleted, 1 MiB\n"));
}

TEST_F(CommandOrthanc, CtrlCLeavesNothingHalfWritten) {
  ASSERT_EQ(json("send " + phantom().string() + " --json")["sent"], 60);
  const std::string series = json("find --json")["studies"][0]["series"][0]["series_uid"];
  const fs::path folder = fresh_path("interrupted");
  // SIGTERM, which ends it as Ctrl-C does, as soon as the first file has come; a fetch that was faster left all of it.
  const Outcome outcome =
      run_command("XDG_CONFIG_HOME=" + (home_ / "config").string() + " sh -c '" + PALPATE_PROGRAM + " fetch " + series +
                  " -o " + folder.string() + " 2>&1 & pid=$!; for n in $(seq 1000); do ls -A " + folder.string() +
                  " 2>/dev/null | grep -q . && break; sleep 0.002; done; kill -TERM $pid; wait $pid'");
  const bool whole = outcome.exit == 0;
  EXPECT_EQ(fs::exists(folder), whole) << outcome.output;
  EXPECT_EQ(outcome.output.find("cancelled") == std::string::npos, whole) << outcome.output;
}

}  // namespace
}  // namespace palpate::plugin
