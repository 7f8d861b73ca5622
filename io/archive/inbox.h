#pragma once

/// Writes the images of a fetch into its folder. Used by C-GET and by our storage service. Not installed.

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
  /// Makes the folder and a hidden one in it, which holds the files until all have arrived. Throws ArchiveError naming
  /// the folder.
  Inbox(const std::filesystem::path& folder, const FetchLimits& limits);
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;
  /// Removes files that finish() has not moved, and the folder if it was made here and is empty.
  ~Inbox();

  /// Sets the study or series that is accepted from now on.
  void expect(const Wanted& wanted);

  /// Reads the dataset that follows a C-STORE request, and returns the status to answer with. Throws ArchiveError if
  /// the disk is full or a limit is passed, and Cancelled if keep_going returns false. The association must then be
  /// aborted, because its dataset was not read to the end. `broken` reports a connection that broke.
  std::uint16_t store(T_ASC_Association& association, Watch& watch, int silence_s, const Command& command,
                      const KeepGoing& keep_going, OFCondition& broken);

  /// The number of images of the wanted study or series that came since the last expect(). An image counts even if it
  /// had come before, when another study or series was expected.
  std::size_t came() const noexcept { return came_.load(std::memory_order_relaxed); }
  std::size_t files() const noexcept { return files_.load(std::memory_order_relaxed); }
  std::uint64_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }
  /// The bytes of all datasets, including the one being received and those not kept.
  std::uint64_t received_bytes() const noexcept { return received_bytes_.load(std::memory_order_relaxed); }
  /// The number of objects of other studies or series, which were not kept.
  std::size_t unasked() const noexcept { return unasked_.load(std::memory_order_relaxed); }

  /// Moves all received files to their places.
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
  std::set<std::string> instances_, instances_of_wanted_;
  std::size_t number_ = 0;
  std::atomic<std::size_t> files_{0}, came_{0}, unasked_{0};
  std::atomic<std::uint64_t> bytes_{0}, received_bytes_{0};
};

}  // namespace palpate::io
