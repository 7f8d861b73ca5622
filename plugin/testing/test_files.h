#pragma once

/// A place for the files of tests.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "io/fresh_folder.h"

namespace palpate::plugin::testing {

/// A path at which no file exists, in a folder that is deleted when this test process ends. A child process that must
/// not delete the folder ends by _exit().
inline std::filesystem::path fresh_path(const std::string& name) {
  static const io::FreshFolder folder = io::temporary_folder();
  auto path = folder.path() / name;
  std::filesystem::remove_all(path);
  std::filesystem::remove(path.string() + ".partial");
  return path;
}

/// The content of a file; empty if there is no file.
inline std::string text_in(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace palpate::plugin::testing
