#pragma once

/// Label maps that clients sent: each lies in a file of a temporary folder, under the name that its client gave it. In
/// scenes on the wire its file is called "openigtlink:NAME", whichever file it lies in now.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/fresh_folder.h"
#include "modes/scene/scene.h"

namespace palpate::plugin::igtl {

class Received {
 public:
  /// How many names there may be, and files of each.
  static constexpr std::size_t most_maps = 8, most_files = 4;

  /// Where a new map of that name is to be written: beside the one that is there now, which is still read. Throws
  /// Refusal if there are too many names.
  std::filesystem::path fresh_file(const std::string& name);
  /// Where the map of that name lies; empty if there is none.
  std::filesystem::path file_of(const std::string& name) const;
  /// From now on the name means that file. Of those before the last few stay: a change of scene may be undone.
  void use(const std::string& name, const std::filesystem::path& file);

  /// The scene with the names of maps in place of their files, for the wire.
  modes::Scene with_names(modes::Scene scene) const;
  /// The other way round. Throws InvalidInput if it names a map that was not sent.
  modes::Scene with_files(modes::Scene scene) const;

 private:
  io::FreshFolder folder_ = io::temporary_folder();
  std::map<std::string, std::vector<std::filesystem::path>> files_;  // the newest last
  int written_ = 0;
};

}  // namespace palpate::plugin::igtl
