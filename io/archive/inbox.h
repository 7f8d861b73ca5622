#pragma once

/// Receives the objects of a fetch and moves them into the folder. Shared by C-GET and our storage service; not
/// installed.

#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "io/archive/association.h"
#include "io/archive/fetch.h"
#include "io/archive/find.h"

namespace palpate::io {

class Inbox {
 public:
  /// Makes the folder, and in it a hidden one for the files until all have been received. Throws ArchiveError that
  /// names the folder.
  Inbox(const std::filesystem::path& folder, const FetchLimits& limits);
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;
  /// Removes the files that finish() has not moved, and the folder if it was made here and is empty.
  ~Inbox();

  /// Which objects are accepted from now on.
  void expect(const Wanted& wanted);

  /// Reads the dataset that follows a C-STORE request, and returns the status to answer with. Throws ArchiveError if
  /// the disk is full or a limit is exceeded, and Cancelled if keep_going returns false; then the association must be
  /// aborted, since its dataset was not read to its end. `broken` is set if the connection breaks.
  std::uint16_t store(T_ASC_Association& association, Watch& watch, int silence_s, const Command& command,
                      const KeepGoing& keep_going, OFCondition& broken);

  std::size_t files() const noexcept { return files_.load(std::memory_order_relaxed); }
  std::uint64_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }
  /// Bytes of all datasets, including the one that is being received and those that are not kept.
  std::uint64_t received_bytes() const noexcept { return received_bytes_.load(std::memory_order_relaxed); }
  /// The number of objects of other studies or series, which were not kept.
  std::size_t unasked() const noexcept { return unasked_.load(std::memory_order_relaxed); }

  /// Moves all files that were received to their places.
  std::vector<FetchedSeries> finish();

 private:
  struct Series {
    std::string study_uid;
    std::filesystem::path folder;  // in staging
    std::size_t files = 0;
    bool refused = false;
  };
  struct Header {
    std::string study_uid, series_uid;
  };
  bool is_wanted(const Header& header);
  void keep(const std::filesystem::path& file, const Header& header);

  std::filesystem::path folder_, staging_;
  bool made_folder_ = false;
  FetchLimits limits_;
  std::mutex mutex_;
  Wanted wanted_;
  std::map<std::string, Series> series_;
  std::set<std::string> instances_;
  std::size_t number_ = 0;
  std::atomic<std::size_t> files_{0}, unasked_{0};
  std::atomic<std::uint64_t> bytes_{0}, received_bytes_{0};
};

}  // namespace palpate::io
