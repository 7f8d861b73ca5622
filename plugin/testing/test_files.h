#pragma once

/// A place for the files of tests.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "io/fresh_folder.h"

namespace palpate::plugin::testing {

/// A path, with nothing there, in a folder of this test process that goes with it. A child process that is to leave the
/// folder to its parent ends by _exit().
inline std::filesystem::path fresh_path(const std::string& name) {
  static const io::FreshFolder folder = io::temporary_folder();
  auto path = folder.path() / name;
  std::filesystem::remove_all(path);
  std::filesystem::remove(path.string() + ".partial");
  return path;
}

/// All that a file holds; empty where there is none.
inline std::string text_in(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace palpate::plugin::testing
