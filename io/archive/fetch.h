#pragma once

/// Fetches studies and series from an archive into a folder: by C-GET, or by C-MOVE to our own storage service, which
/// listens only during the fetch.

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
  int expected = -1;  ///< number of images by the archive's count; -1: unknown
};

/// Called with the progress at least once a second, by one thread at a time: the thread that called fetch(), or the one
/// that watches its connection. Returns false to cancel.
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
  std::vector<Text> warnings;  ///< what is missing, and why; in the user's words
};

/// Fetches the studies or series with these UIDs into `folder`. A missing folder is made, readable by its owner alone.
/// Each series gets a subfolder, and its files get names that we choose. Throws Cancelled if the watcher returns false,
/// and ArchiveError for every other failure; a fetch that throws leaves no files.
Fetched fetch(const Archive& archive, const std::vector<std::string>& uids, const std::filesystem::path& folder,
              const FetchLimits& limits = {}, const FetchWatcher& watcher = {});

}  // namespace palpate::io
