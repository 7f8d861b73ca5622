#pragma once

/// Stores files in an archive (C-STORE), for example marks and measurements beside their scan.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/archive/archive.h"

namespace palpate::io {

struct NotSent {
  std::filesystem::path file;
  Text why;
};

struct Sent {
  std::size_t files = 0;          ///< files that the archive accepted
  std::vector<NotSent> not_sent;  ///< files that it refused, or that are not DICOM
  std::vector<NotSent> warned;    ///< accepted with a warning (PS3.4 B.2.3: changed, or with elements left out)
};

/// Sends the files in their own encoding. Throws ArchiveError if there is no association or it breaks, and Cancelled if
/// `progress` returns false. `progress` gets the number of files done, before each file and once a second while the
/// archive does not answer. Files that it has accepted before stay in the archive.
Sent send(const Archive& archive, const std::vector<std::filesystem::path>& files,
          const std::function<bool(std::size_t done)>& progress = {});

}  // namespace palpate::io
