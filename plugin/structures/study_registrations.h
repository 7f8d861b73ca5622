#pragma once

/// The registrations of a study, looked for beside its structures.

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "io/progress.h"
#include "io/structures/structure.h"
#include "io/volume.h"

namespace palpate::plugin {

/// Reads each file once, however many structures ask for it.
class StudyRegistrations {
 public:
  static constexpr std::size_t most_files = 20000;  ///< beside one structure

  /// `progress` starts again with each folder.
  explicit StudyRegistrations(io::Progress progress = {}, std::size_t most = most_files)
      : progress_(std::move(progress)), most_(most) {}

  /// The registrations for a structure whose frame of reference is not the scan's: those in the folder of its file with
  /// all that it holds, and in the folders beside that one, as a study is stored; by file. Empty if the frames are the
  /// same. Adds to the structure's warnings if more files lie there than are read. Throws Cancelled.
  std::vector<io::Registration> beside(io::Structure& structure, const io::Volume& scan);

 private:
  struct Folder {
    std::set<std::filesystem::path> files;
    bool is_whole = true;
  };
  const Folder& files_beside(const std::filesystem::path& folder);

  io::Progress progress_;
  std::size_t most_;
  std::map<std::filesystem::path, Folder> folders_;
  std::map<std::filesystem::path, std::optional<io::Registration>> read_;
};

}  // namespace palpate::plugin
