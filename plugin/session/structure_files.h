#pragma once

/// Files of structures by their content. A recording names them so: no path goes into it, for one may hold a patient's
/// name.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "modes/scene/scene.h"

namespace palpate::plugin {

/// 16 hexadecimal digits; all zero where the file cannot be read.
std::string hash_of_file(const std::filesystem::path& file);

/// The scene with the hash of its content in place of the name of each structure's file.
modes::Scene without_paths(modes::Scene scene);

/// What lies under some places.
class StructureFiles {
 public:
  StructureFiles() = default;
  /// Files and folders; looked through when a scene asks for a structure.
  explicit StructureFiles(std::vector<std::filesystem::path> places) : places_(std::move(places)) {}

  /// The scene that without_paths() was given, with the files as they are here. Throws std::invalid_argument naming a
  /// structure whose file is not.
  modes::Scene with_paths(modes::Scene scene);

 private:
  std::vector<std::filesystem::path> places_;
  std::map<std::string, std::filesystem::path> by_hash_;
  bool looked_ = false;
};

}  // namespace palpate::plugin
