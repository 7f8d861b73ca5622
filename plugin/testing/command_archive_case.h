#pragma once

/// Runs archive commands with separate settings and fetched files, and has a recording to send.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "plugin/testing/command_rig.h"

namespace palpate::plugin::testing {

/// Each test has its own settings and fetched files.
class CommandArchive : public ::testing::Test {
 protected:
  void SetUp() override {
    home_ = fresh_path("home");
    std::filesystem::create_directories(home_);
  }
  Outcome run(const std::string& arguments, bool with_errors = true) const {
    return run_command("XDG_CONFIG_HOME=" + (home_ / "config").string() +
                       " XDG_CACHE_HOME=" + (home_ / "cache").string() + " " + PALPATE_PROGRAM + " " + arguments +
                       (with_errors ? " 2>&1" : " 2>/dev/null"));
  }
  nlohmann::json json(const std::string& arguments) const {
    return nlohmann::json::parse(run(arguments, false).output);
  }
  std::filesystem::path settings() const { return home_ / "config/palpate/archives.json"; }

  std::filesystem::path home_;
};

/// A ball whose hand presses the second button twice on the surface, and keeps it down once.
inline std::filesystem::path path_with_buttons() {
  const std::filesystem::path file = fresh_path("path.csv");
  std::ofstream(file) << "time_s,x_mm,y_mm,z_mm,buttons\n"
                         "0,0,-29,0,0\n0.4,0,-23,0,0\n0.6,0,-23,0,2\n0.7,0,-23,0,0\n"
                         "1.2,8,-22,0,0\n1.4,8,-22,0,2\n1.5,8,-22,0,0\n"
                         "1.6,8,-22,0,2\n2.4,-8,-22,0,0\n2.6,-8,-22,0,0\n";
  return file;
}

/// A recording of it on a scan.
inline std::filesystem::path recorded(const std::filesystem::path& scan) {
  const std::filesystem::path out = fresh_path("probed");
  const Outcome probed =
      palpate("probe " + scan.string() + " --path " + path_with_buttons().string() + " -o " + out.string());
  EXPECT_EQ(probed.exit, 0) << probed.output;
  return out / "recording.h5";
}

}  // namespace palpate::plugin::testing
