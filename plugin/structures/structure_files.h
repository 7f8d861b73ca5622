#pragma once

/// Names files of structures by a hash of their content. Recordings use these names, because a path may contain a
/// patient's name.

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "modes/scene/scene.h"

namespace palpate::plugin {

/// 16 hexadecimal digits; all zero if the file cannot be read. A file is read again only if its time or size changed.
std::string hash_of_file(const std::filesystem::path& file);
/// Whether this is the hash of a file that could be read.
bool is_known(const std::string& hash);

/// Time and size of a file. Another program that writes the file changes them.
struct FileState {
  std::filesystem::file_time_type time;
  std::uintmax_t size = 0;

  auto operator<=>(const FileState&) const = default;
};
/// None if there is no such file.
std::optional<FileState> state_of_file(const std::filesystem::path& file);

/// The folder beside a recording with the structures that were felt and have no file of their own: label maps that came
/// over the network. "a.h5.structures" for a.h5, a.h5.partial and a.h5.2.partial.
std::filesystem::path structures_beside(const std::filesystem::path& recording);

/// Sets the local copies of a server's files, by their names on the server, which scenes use. From any thread. Replaces
/// those of the previous call.
void set_fetched_files(std::map<std::filesystem::path, std::filesystem::path> here_by_name);
/// The local path of the file with that name: the name itself, unless it was fetched.
std::filesystem::path copy_of(const std::filesystem::path& name);
/// A scene's name for a local file: its own path, unless it was fetched.
std::filesystem::path name_of_copy(const std::filesystem::path& here);

/// The scene, with the hash of each structure's file in place of its name.
modes::Scene without_paths(modes::Scene scene);

/// The structure files in some folders, found by their hash.
class StructureFiles {
 public:
  StructureFiles() = default;
  /// Files and folders. They are searched when a scene asks for a structure.
  explicit StructureFiles(std::vector<std::filesystem::path> places) : places_(std::move(places)) {}

  /// The scene before without_paths(), with the local names of the files. Throws std::invalid_argument naming a
  /// structure whose file is missing.
  modes::Scene with_paths(modes::Scene scene);

 private:
  std::vector<std::filesystem::path> places_;
  std::map<std::string, std::filesystem::path> by_hash_;
  bool looked_ = false;
};

}  // namespace palpate::plugin
