#pragma once

/// Storing files in an archive (C-STORE): what was marked and measured goes back where the scan came from.

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
  std::size_t files = 0;          ///< that the archive took
  std::vector<NotSent> not_sent;  ///< that it did not take, or that are no DICOM files
  std::vector<NotSent> warned;    ///< that it took with a warning (PS3.4 B.2.3: changed, or with elements left out)
};

/// Sends the files as they are, in the encoding they have. Throws ArchiveError where there is no association or it
/// breaks, Cancelled where `progress` returns false. It is called with the number of files done, before each file and
/// once a second while the archive does not answer. What the archive has taken by then stays there.
Sent send(const Archive& archive, const std::vector<std::filesystem::path>& files,
          const std::function<bool(std::size_t done)>& progress = {});

}  // namespace palpate::io
