#pragma once

/// Label maps sent by clients: each is stored in a file of a temporary folder under the client's name for it. In scenes
/// on the wire the file is called "openigtlink:NAME", independently of its present file. The maps of a recorded session
/// are also kept for its replay.

#include <filesystem>
#include <future>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/fresh_folder.h"
#include "modes/scene/scene.h"

namespace palpate::plugin::igtl {

class Received {
 public:
  /// Limits on the number of names, and of files for each.
  static constexpr std::size_t most_maps = 8, most_files = 4;

  Received() = default;
  /// `keep_in`: a folder for copies of the maps that are used, by the hash of their content (hash_of_file()). Empty:
  /// none are kept. The folder is made for the first map.
  explicit Received(std::filesystem::path keep_in) : keep_in_(std::move(keep_in)) {}

  /// The file for a new map of that name. It lies beside the present file, which may still be read. Throws Refusal if
  /// there are too many names.
  std::filesystem::path fresh_file(const std::string& name);
  /// The file of the map with that name; empty if there is none.
  std::filesystem::path file_of(const std::string& name) const;
  /// From now on the name refers to that file. The latest few files before it are kept, because a change of scene may
  /// be undone. A copy is made in another thread, and reported on stderr.
  void use(const std::string& name, const std::filesystem::path& file);

  /// The scene with names of maps in place of their files, for the wire.
  modes::Scene with_names(modes::Scene scene) const;
  /// The inverse. Throws InvalidInput if the scene names a map that was not sent.
  modes::Scene with_files(modes::Scene scene) const;

 private:
  io::FreshFolder folder_ = io::temporary_folder();
  std::map<std::string, std::vector<std::filesystem::path>> files_;  // the newest last
  int written_ = 0;
  std::filesystem::path keep_in_;
  std::vector<std::future<void>> copies_;  // after the folder: they read it to their end
};

}  // namespace palpate::plugin::igtl
