#pragma once

/// The registrations of a study, searched beside its structures.

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

/// Reads each file once for any number of structures.
class StudyRegistrations {
 public:
  static constexpr std::size_t most_files = 20000;  ///< beside one structure

  /// `progress` starts again with each folder.
  explicit StudyRegistrations(io::Progress progress = {}, std::size_t most = most_files)
      : progress_(std::move(progress)), most_(most) {}

  /// The registrations for a structure whose frame of reference is not the scan's, sorted by file: those in the folder
  /// of its file, with all subfolders, and in the folders beside it. Empty if the frames are the same. Adds a warning
  /// to the structure if there are more files than are read. Throws Cancelled.
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
