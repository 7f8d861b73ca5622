// Registrations beside structures: each file is opened once for any number of structures; bounded; can be cancelled.
#include "plugin/structures/study_registrations.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "io/errors.h"
#include "plugin/messages/messages.h"
#include "plugin/testing/opened_files.h"
#include "plugin/testing/registered_study.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using io::internal::TestFolder;
using testing::OpenedFiles;

/// Structures in two folders of a study, a registration in a third one, and scans.
struct RegisteredFolders {
  RegisteredFolders() {
    for (const std::string name : {"a1", "a2", "a3"}) write("a", name);
    for (const std::string name : {"b1", "b2"}) write("b", name);
    testing::write_registration(study / "c" / "reg.dcm");
    for (int n = 0; n < 6; ++n) io::internal::write({}, study / "c" / ("slice" + std::to_string(n)));
    std::ofstream(study / "c" / "notes.txt") << "no DICOM";
    folders = {study / "a", study / "b", study / "c"};
    structures = io::find_structures(folders).structures;
  }
  void write(const std::string& folder, const std::string& name) const {
    testing::write_contours(study / folder / name, "1.2", "7", "Doe^Jane");
  }

  TestFolder place;
  fs::path study = place.path();
  std::vector<fs::path> folders;
  std::vector<io::Structure> structures;
};

TEST(StudyRegistrations, ReadEachFileOnceForAllStructures) {
  RegisteredFolders all;
  ASSERT_EQ(all.structures.size(), 5U);
  OpenedFiles opened(all.folders);
  StudyRegistrations study;
  for (io::Structure& structure : all.structures) {
    const auto found = study.beside(structure, *testing::registered_scan());
    ASSERT_EQ(found.size(), 1U) << structure.file;
    EXPECT_EQ(found[0].file, all.study / "c" / "reg.dcm");
    EXPECT_TRUE(structure.warnings.empty());
  }
  const auto count = opened.count();
  EXPECT_EQ(count.size(), 13U);
  // Once to read its header; where it is a registration, the same.
  for (const auto& [file, times] : count) EXPECT_EQ(times, 1) << file;
}

TEST(StudyRegistrations, OfStructuresInTheScansFrameAreNotLookedFor) {
  RegisteredFolders all;
  OpenedFiles opened(all.folders);
  StudyRegistrations study;
  for (const std::string frame : {"1.1", ""}) {
    all.structures[0].frame_of_reference_uid = frame;
    EXPECT_TRUE(study.beside(all.structures[0], *testing::registered_scan()).empty());
  }
  EXPECT_TRUE(opened.count().empty());
}

TEST(StudyRegistrations, AreLookedForInSoManyFilesAndNoMore) {
  RegisteredFolders all;
  for (const std::size_t most : {2U, 5U, 12U}) {
    OpenedFiles opened(all.folders);
    StudyRegistrations study({}, most);
    io::Structure structure = all.structures[0];
    study.beside(structure, *testing::registered_scan());
    EXPECT_LE(opened.count().size(), most);
    ASSERT_EQ(structure.warnings.size(), 1U);
    EXPECT_EQ(structure.warnings[0], "more than " + std::to_string(most) + " files lie beside " +
                                         structure.file.filename().string() +
                                         ": registrations (REG) are looked for only in the first ones");
  }
}

TEST(StudyRegistrations, CanBeCancelled) {
  RegisteredFolders all;
  StudyRegistrations study([](double) { return false; });
  EXPECT_THROW(study.beside(all.structures[0], *testing::registered_scan()), io::Cancelled);
}

}  // namespace
}  // namespace palpate::plugin
