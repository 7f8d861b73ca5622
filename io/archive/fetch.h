#pragma once

/// Fetching studies and series from an archive into a folder: by C-MOVE to a storage service of our own, which listens
/// only meanwhile, or by C-GET.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/archive/archive.h"

namespace palpate::io {

struct FetchLimits {
  std::uint64_t bytes = 32ULL << 30U;  ///< of all files together
  std::size_t files = 100000;
};

struct FetchProgress {
  std::size_t files = 0;
  std::uint64_t bytes = 0;
  int expected = -1;  ///< images, as the archive counts them; -1: it does not say
};

/// Called with what has come, at least once a second, on the thread that called fetch(). False cancels.
using FetchWatcher = std::function<bool(const FetchProgress&)>;

struct FetchedSeries {
  std::string uid, study_uid;
  std::filesystem::path folder;
  std::size_t files = 0;
};

struct Fetched {
  std::vector<FetchedSeries> series;
  std::size_t files = 0;
  std::uint64_t bytes = 0;
  bool complete = true;        ///< false: the archive could not send all of it
  std::vector<Text> warnings;  ///< what did not come, and why; in the user's words
};

/// Fetches what the UIDs name (studies or series) into `folder`, which is made where it is not there, readable by its
/// owner alone; each series gets a folder of its own there, with names that we give. Nothing is left of a fetch that
/// throws: Cancelled where the watcher said so, ArchiveError for all else.
Fetched fetch(const Archive& archive, const std::vector<std::string>& uids, const std::filesystem::path& folder,
              const FetchLimits& limits = {}, const FetchWatcher& watcher = {});

}  // namespace palpate::io
