// Another program may rewrite the file of a structure during a session: what is felt is named by what was read.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "plugin/structures/scene_structures.h"
#include "plugin/structures/shared_distance.h"
#include "plugin/structures/structure_files.h"
#include "plugin/testing/registered_study.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;

struct RewrittenStructures : ::testing::Test {
  RewrittenStructures() {
    testing::write_contours(file, "1.1", "7", "Doe^Jane");
    for (io::Vec3& position : volume->geometry.slice_positions) position.x = -40;
    plan.structures = {0};
  }
  std::vector<LoadedStructure> load(const std::vector<LoadedStructure>& before) const {
    return load_structures(testing::scene_of(file), plan, volume, before);
  }
  bool is_loaded(const std::vector<LoadedStructure>& before) const {
    return are_loaded(testing::scene_of(file), plan, before);
  }

  io::internal::TestFolder folder;
  fs::path file = folder / "rt.dcm";
  std::shared_ptr<io::Volume> volume = std::make_shared<io::Volume>(*testing::registered_scan());
  modes::Plan plan;
};

/// What is felt and shown stays what was read; a structure that is added anew is read from its file.
TEST_F(RewrittenStructures, AreFeltAsTheyWereRead) {
  const auto first = load({});
  const std::string hash = hash_of_file(file);
  EXPECT_EQ(first.at(0).hash, hash);
  EXPECT_TRUE(is_loaded(first));
  EXPECT_LT(first[0].distance->sample({-11, -11, 9}).mm, 0) << "outside";

  testing::move_corner(file);
  EXPECT_TRUE(is_loaded(first));
  EXPECT_EQ(load(first).at(0).distance, first[0].distance);
  EXPECT_EQ(load(first).at(0).hash, hash) << "as a recording names it";
  const auto again = load({});
  // From the side through -16, -16 and 10, -10.
  EXPECT_NEAR(again.at(0).distance->sample({-13, -13, 9}).mm, (26 * 3 - 6 * 3) / std::hypot(26, 6), 0.5);
  EXPECT_NE(again[0].hash, hash);
  EXPECT_EQ(again[0].hash, hash_of_file(file));
}

/// As a program that keeps the time: rsync, cp -p.
TEST_F(RewrittenStructures, OfTheSameTimeAreKnownByTheirSize) {
  const auto first = load({});
  const auto time = fs::last_write_time(file);
  testing::write_contours(file, "1.1", "7", "Doe^Jane^of^another^length");
  fs::last_write_time(file, time);
  const io::Structure structure = io::find_structures(std::array{file}).structures.at(0);
  EXPECT_NE(shared_distance(structure, volume->geometry, first[0].distance->reach_mm()), first[0].distance);
}

TEST_F(RewrittenStructures, ThatAreDamagedOrGoneAreFeltAsTheyWereRead) {
  const auto first = load({});
  fs::resize_file(file, 100);
  EXPECT_TRUE(is_loaded(first));
  EXPECT_EQ(load(first).at(0).distance, first[0].distance);
  EXPECT_THROW(load({}), std::exception);
  fs::remove(file);
  EXPECT_TRUE(is_loaded(first));
  EXPECT_EQ(load(first).at(0).hash, first[0].hash);
}

TEST_F(RewrittenStructures, WhileTheyAreReadAreRefused) {
  const fs::path versions[] = {folder / "one", folder / "other"};
  for (const fs::path& version : versions) fs::copy_file(file, version);
  testing::move_corner(versions[1]);
  const auto put = [&](const fs::path& version) {
    fs::create_hard_link(version, folder / "next");
    fs::rename(folder / "next", file);
  };
  for (const fs::path& version : versions) {
    put(version);
    hash_of_file(file);  // it is not read for this any more
  }
  std::string said;
  {
    const std::jthread writer([&](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        for (const fs::path& version : versions) put(version);
      }
    });
    for (int n = 0; n < 200 && said.empty(); ++n) {  // half of them meet the same version at the end
      try {
        load({});
      } catch (const std::invalid_argument& error) {
        said = error.what();
      }
    }
  }
  EXPECT_EQ(
      said,
      "structure \"cube\": rt.dcm was written while it was being read: wait for the other program, and try again");
}

}  // namespace
}  // namespace palpate::plugin
