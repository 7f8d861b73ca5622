// Who was scanned, and where the scan lies, stay out of everything that a session leaves behind.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "plugin/testing/test_files.h"
#include "testdata/scan.h"
#include "testdata/write_series.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;

int run(const std::string& words) {
  const int status = std::system((std::string(PALPATE_PROGRAM) + " " + words).c_str());  // NOLINT: the test's own words
  return WEXITSTATUS(status);
}

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Identity, IsNeitherInRecordingNorPicturesNorReports) {
  const fs::path work = testing::fresh_path("identity");
  fs::create_directories(work);
  const fs::path scan = work / "Zaphodsmith";
  testdata::Grid grid;
  grid.size = {40, 40, 40};
  const testdata::Layer layers[] = {{-8, testdata::soft_tissue_hu}, {2, testdata::bone_hu}};
  const testdata::Phantom slab = testdata::make_slab({0, 1, 0}, layers);
  testdata::write_series(testdata::scan(slab, testdata::make_geometry(grid)), scan,
                         {.description = "phantom", .subject = "Beeblebrox-4711"});

  const fs::path out = work / "session";
  const std::string quiet = " >" + (work / "out.txt").string() + " 2>" + (work / "err.txt").string();
  ASSERT_EQ(
      run("probe " + scan.string() + " --scene ct-skin-and-bone --from=0,-19,0 --to=0,0,0 -o " + out.string() + quiet),
      0)
      << content_of(work / "err.txt");
  ASSERT_EQ(run("info --json " + scan.string() + " >" + (work / "info.json").string()), 0);
  ASSERT_EQ(run("info --patient " + scan.string() + " >" + (work / "info_patient.txt").string()), 0);

  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(out)) {
    if (!entry.is_regular_file()) continue;
    ++files;
    const std::string content = content_of(entry.path());
    EXPECT_EQ(content.find("Beeblebrox"), std::string::npos) << entry.path();
    EXPECT_EQ(content.find("Zaphodsmith"), std::string::npos) << entry.path();
  }
  EXPECT_GE(files, 4);
  for (const char* said : {"out.txt", "err.txt", "info.json"}) {
    const std::string content = content_of(work / said);
    EXPECT_EQ(content.find("Beeblebrox"), std::string::npos) << said;
    EXPECT_EQ(content.find("Zaphodsmith"), std::string::npos) << said;
  }
  // On request it is shown, or this test would look for what is nowhere.
  EXPECT_NE(content_of(work / "info_patient.txt").find("Beeblebrox"), std::string::npos);
}

}  // namespace
}  // namespace palpate::plugin
