#pragma once

/// Shared by tests of the program: running it, and a phantom to run it on.

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

#include "plugin/testing/test_files.h"
#include "testdata/scan.h"
#include "testdata/write_series.h"

namespace palpate::plugin::testing {

struct Outcome {
  int exit = -1;
  std::string output;  // stdout, or both where asked for
};

inline Outcome run_command(const std::string& command) {
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");  // NOLINT: the tests' own arguments
  std::array<char, 4096> buffer{};
  while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe)) {
    outcome.output.append(buffer.data(), count);
  }
  outcome.exit = WEXITSTATUS(pclose(pipe));
  return outcome;
}

inline Outcome palpate(const std::string& arguments, bool with_errors = true) {
  return run_command(std::string(PALPATE_PROGRAM) + " " + arguments + (with_errors ? " 2>&1" : " 2>/dev/null"));
}

/// All output of a shell command.
inline std::string output_of(const std::string& command) {
  return run_command("{ " + command + "; } 2>&1").output;
}

/// A ball of soft tissue with a core of bone, 60 mm wide, as a DICOM series.
inline const std::filesystem::path& phantom() {
  static const std::filesystem::path folder = [] {
    auto path = fresh_path("phantom");
    testdata::Phantom ball = testdata::make_sphere(25);
    ball.bodies.push_back(testdata::make_sphere(15, testdata::bone_hu).bodies.front());
    testdata::write_series(testdata::scan(ball, testdata::make_geometry({.size = glm::ivec3(60)})), path);
    return path;
  }();
  return folder;
}

inline const std::string forehead = " --from 0,-29,0 --to 0,0,0 ";

}  // namespace palpate::plugin::testing
