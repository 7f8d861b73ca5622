#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>

#include "device/safety/guardian.h"
#include "device/testing/test_files.h"
#include "solver/text/testing/shown.h"

/// Where the guardian's program is looked for.
namespace palpate::device {
namespace {

/// A folder of its own with a program in it at each of these paths.
class Places {
 public:
  Places(std::initializer_list<const char*> guardians) {
    for (const char* place : guardians) {
      const std::filesystem::path file = root_ / place;
      std::filesystem::create_directories(file.parent_path());
      std::ofstream(file) << "#!/bin/sh\n";
      std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    }
  }

  /// The first candidate that is there, from the root; empty where none is.
  std::string found_by(const std::string& program, const std::string& loaded_from) const {
    for (const std::string& candidate : guardian_candidates(root_ / program, root_ / loaded_from,
                                                            root_ / "configured/libexec/palpate/palpate-guardian")) {
      if (access(candidate.c_str(), X_OK) == 0) return std::filesystem::relative(candidate, root_);
    }
    return {};
  }

 private:
  TestFiles files_;
  std::filesystem::path root_ = std::filesystem::path(files_.write("root", "")).parent_path();
};

/// It leaves its group by the user's systemd, whose socket is in the folder that the environment names.
TEST(Guardian, LeavesItsGroupWhereTheUsersSystemdRuns) {
  const TestFiles files;
  const std::filesystem::path root = std::filesystem::path(files.write("file", "")).parent_path();
  const std::filesystem::path bare = root / "bare", half = root / "half", whole = root / "whole";
  std::filesystem::create_directories(bare);
  std::filesystem::create_directories(half / "systemd");
  std::filesystem::create_directories(whole / "systemd");
  std::ofstream(whole / "systemd/private") << "";
  const char* const set = std::getenv("XDG_RUNTIME_DIR");
  const std::string before = set != nullptr ? set : "";
  unsetenv("XDG_RUNTIME_DIR");
  EXPECT_FALSE(guardian_can_leave_group()) << "as under ssh, cron and sudo";
  for (const auto& folder : {bare, half, whole, root / "absent"}) {
    setenv("XDG_RUNTIME_DIR", folder.c_str(), 1);
    EXPECT_EQ(guardian_can_leave_group(), folder == whole) << folder;
  }
  unsetenv("XDG_RUNTIME_DIR");
  if (!before.empty()) setenv("XDG_RUNTIME_DIR", before.c_str(), 1);
}

TEST(Guardian, IsFoundBesideTheTests) {
  EXPECT_NE(guardian_program().find("palpate-guardian"), std::string::npos);
}

// Not a test of its own: what it prints is looked at below.
TEST(Guardian, DISABLED_IsTold) {
  std::puts(guardian_program().c_str());
}

/// As the plug-in's in ParaView: the program that runs, here the dynamic loader, is nowhere near.
TEST(Guardian, IsFoundBesideWhatItWasLoadedFromWhateverProgramRuns) {
  std::string loader;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; loader.empty() && std::getline(maps, line);) {
    if (line.find("/ld-linux") != std::string::npos) loader = line.substr(line.find('/'));
  }
  ASSERT_FALSE(loader.empty());
  const std::string said =
      palpate::testing::output_of(loader + " " + std::filesystem::read_symlink("/proc/self/exe").string() +
                                  " --gtest_also_run_disabled_tests --gtest_filter=Guardian.DISABLED_IsTold");
  EXPECT_NE(said.find("\n" + guardian_program() + "\n"), std::string::npos) << said;
}

TEST(Guardian, IsFoundOfABuildByItsProgramsAndByThePluginInParaView) {
  const Places build{"build/bin/palpate-guardian"};
  EXPECT_EQ(build.found_by("build/bin/palpate", "build/bin/palpate"), "build/bin/palpate-guardian");
  EXPECT_EQ(build.found_by("usr/bin/paraview", "build/plugin/paraview/client/PalpatePanel.so"),
            "build/bin/palpate-guardian");
}

TEST(Guardian, IsFoundOfAnInstalledPluginWhereverItWasMovedTo) {
  for (const char* library : {"lib/paraview/plugins/PalpatePanel/PalpatePanel.so",
                              "lib/x86_64-linux-gnu/paraview-5.11/plugins/PalpatePanel/PalpatePanel.so"}) {
    const Places moved{"opt/palpate/libexec/palpate/palpate-guardian"};
    EXPECT_EQ(moved.found_by("usr/bin/paraview", std::string("opt/palpate/") + library),
              "opt/palpate/libexec/palpate/palpate-guardian");
    const Places configured{"configured/libexec/palpate/palpate-guardian"};
    EXPECT_EQ(configured.found_by("usr/bin/paraview", std::string("elsewhere/") + library),
              "configured/libexec/palpate/palpate-guardian");
  }
}

TEST(Guardian, ItsNearestCopyIsTaken) {
  const Places two{"build/bin/palpate-guardian", "configured/libexec/palpate/palpate-guardian", "bin/palpate-guardian"};
  EXPECT_EQ(two.found_by("usr/bin/paraview", "build/plugin/PalpatePanel.so"), "build/bin/palpate-guardian");
}

TEST(Guardian, IsNotFoundWhereThereIsNone) {
  const Places none{"usr/bin/another-program", "plugins/palpate-guardian.txt"};
  EXPECT_EQ(none.found_by("usr/bin/paraview", "plugins/PalpatePanel.so"), "");
}

TEST(Guardian, TheEnvironmentNamesItOrSaysThatThereIsNone) {
  setenv("PALPATE_GUARDIAN", "/opt/my-guardian", 1);
  EXPECT_EQ(guardian_program(), "/opt/my-guardian");
  setenv("PALPATE_GUARDIAN", "", 1);
  EXPECT_EQ(guardian_program(), "");
  EXPECT_EQ(start_guardian({guardian_program(), "wooden_haptics", "/dev/null"}), nullptr);
  unsetenv("PALPATE_GUARDIAN");
}

}  // namespace
}  // namespace palpate::device
