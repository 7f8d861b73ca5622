// A recording contains no path, and finds its structures by the contents of their files.
#include "plugin/structures/structure_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

#include "modes/scene/scene_json.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/testing/registered_study.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;

TEST(StructureFiles, AreNamedByTheirContent) {
  const fs::path folder = fs::path(::testing::TempDir()) / "structure_files";
  fs::create_directories(folder);
  std::ofstream(folder / "a") << "the same";
  std::ofstream(folder / "b") << "the same";
  std::ofstream(folder / "c") << "another";
  EXPECT_EQ(hash_of_file(folder / "a"), hash_of_file(folder / "b"));
  EXPECT_NE(hash_of_file(folder / "a"), hash_of_file(folder / "c"));
  EXPECT_EQ(hash_of_file(folder / "absent"), "0000000000000000");
  // XXH3 of 64 bits with no seed, of no bytes: as xxhsum -H3 prints it.
  std::ofstream(folder / "empty").close();
  EXPECT_EQ(hash_of_file(folder / "empty"), "2d06800538d394c2");
}

TEST(StructureFiles, AreFoundWhereverTheyWentMeanwhile) {
  const fs::path folder = fs::path(::testing::TempDir()) / "moved";
  fs::remove_all(folder);
  testing::write_contours(folder / "first/rt.dcm", "1.1", "7", "Doe^Jane");
  const modes::Scene recorded = without_paths(testing::scene_of(folder / "first/rt.dcm"));
  EXPECT_EQ(modes::to_json(recorded).find("/"), std::string::npos);
  EXPECT_EQ(modes::to_json(without_paths(recorded)), modes::to_json(recorded));
  fs::create_directories(folder / "deep");
  fs::rename(folder / "first/rt.dcm", folder / "deep/renamed");
  EXPECT_EQ(StructureFiles({folder}).with_paths(recorded).structures[0].file, (folder / "deep/renamed").string());
  fs::remove(folder / "deep/renamed");
  try {
    StructureFiles({folder}).with_paths(recorded);
    FAIL() << "was found";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "structure \"cube\": the file that it was felt from is not here: name it with --structures");
  }
}

TEST(StructureFiles, OfSeveralInAFolderEachIsFound) {
  const io::internal::TestFolder folder;
  modes::Scene scene;
  for (const char* const name : {"liver", "aorta", "spleen"}) {
    testing::write_contours(folder / "before" / name, "1.1", name, "Doe^Jane");
    scene.structures.push_back({.name = name, .file = folder / "before" / name, .segment = "Cube"});
  }
  const modes::Scene recorded = without_paths(scene);
  fs::rename(folder / "before", folder / "after");
  const modes::Scene again = StructureFiles({folder.path()}).with_paths(recorded);
  ASSERT_EQ(again.structures.size(), 3U);
  for (const modes::SceneStructure& found : again.structures) EXPECT_EQ(found.file, folder / "after" / found.name);
}

// A path may hold a patient's name: whatever its length and its letters, none but a hash is left as it is.
TEST(StructureFiles, NoneButAHashIsLeftAsItIs) {
  const std::string hash = "0123456789abcdef";
  EXPECT_EQ(without_paths(testing::scene_of(hash)).structures[0].file, hash);
  for (std::size_t at = 0; at < hash.size(); ++at) {
    for (const char letter : {'g', 'z', '.', ' ', '_', '-', '/'}) {
      std::string path = hash;
      path[at] = letter;
      EXPECT_EQ(without_paths(testing::scene_of(path)).structures[0].file, "0000000000000000") << path;
    }
  }
  for (const std::string& path : {hash.substr(1), hash + "0"}) {
    EXPECT_EQ(without_paths(testing::scene_of(path)).structures[0].file, "0000000000000000") << path;
  }
}

// What is said of a server's structure names its file as the server does: the copy here has another name.
TEST(StructureFiles, OfAServerAreNamedAsThere) {
  const io::internal::TestFolder folder;
  testing::write_contours(folder / "copy", "1.1", "7", "Doe^Jane");
  set_fetched_files({{"/there/study/rt.dcm", folder / "copy"}});
  const modes::Scene scene = testing::scene_of("/there/study/rt.dcm");
  const auto elsewhere = std::make_shared<io::Volume>(*testing::registered_scan());
  for (io::Vec3& position : elsewhere->geometry.slice_positions) position.x = 14;  // 4 mm beside the cube
  const auto of_another = std::make_shared<io::Volume>(*elsewhere);
  of_another->patient_id = "8";
  of_another->patient_name = "Roe^Jim";
  std::string said;
  const PreparedScene prepared = prepare(scene, elsewhere, glm::dvec3(0.1));
  for (const Text& warning : prepared.structures.at(0).warnings) said += warning;
  try {
    prepare(scene, of_another, glm::dvec3(0.1));
    ADD_FAILURE() << "taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("rt.dcm"), std::string::npos) << error.what();
  }
  set_fetched_files({});
  EXPECT_NE(said.find("rt.dcm"), std::string::npos) << said;
  EXPECT_EQ(said.find("copy"), std::string::npos) << said;
}

/// Beside the recording, also where its session was cut off, and where that happened twice.
TEST(StructureFiles, LieBesideTheirRecording) {
  const fs::path folder = fs::path(::testing::TempDir()) / "beside_recordings";
  fs::remove_all(folder);
  for (const char* const name : {"a.h5", "run.2", "a", "a.b.h5"}) {
    const fs::path maps = folder / (std::string(name) + ".structures");
    fs::create_directories(maps);
    for (const char* const cut_off : {"", ".partial", ".2.partial", ".17.partial"}) {
      EXPECT_EQ(structures_beside(folder / (std::string(name) + cut_off)), maps) << name << cut_off;
    }
    fs::remove_all(maps);
    EXPECT_EQ(structures_beside(folder / name), maps) << "where they are to be";
  }
}

// A scene that names a file of a server is felt from its copy, and recorded by what is in it.
TEST(StructureFiles, OfAServerAreReadFromTheirCopies) {
  const fs::path folder = fs::path(::testing::TempDir()) / "fetched_structures";
  testing::write_contours(folder / "0/rt.dcm", "1.1", "7", "Doe^Jane");
  const auto volume = std::make_shared<io::Volume>(*testing::registered_scan());
  for (io::Vec3& position : volume->geometry.slice_positions) position.x = -40;
  const modes::Scene scene = testing::scene_of("/there/study/rt.dcm");
  const glm::dvec3 extent(0.1);
  EXPECT_THROW(prepare(scene, volume, extent), std::invalid_argument);
  set_fetched_files({{"/there/study/rt.dcm", folder / "0/rt.dcm"}});
  const PreparedScene prepared = prepare(scene, volume, extent);
  EXPECT_EQ(prepared.structures.at(0).file, "/there/study/rt.dcm");
  EXPECT_NEAR(prepared.structures[0].distance->sample({8, 0, 9}).mm, 2, 0.15);
  EXPECT_EQ(without_paths(scene).structures[0].file, hash_of_file(folder / "0/rt.dcm"));
  EXPECT_EQ(name_of_copy(folder / "0/rt.dcm"), "/there/study/rt.dcm");
  EXPECT_EQ(name_of_copy(folder / "0/other.dcm"), folder / "0/other.dcm");
  set_fetched_files({});
  EXPECT_THROW(prepare(scene, volume, extent), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::plugin
