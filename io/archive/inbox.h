#pragma once

/// What arrives during a fetch, on its way into the folder: shared by C-GET and our storage service. Not installed.

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
  /// Makes the folder and a hidden one in it, where files lie until all have come. Throws ArchiveError naming it.
  Inbox(const std::filesystem::path& folder, const FetchLimits& limits);
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;
  /// Removes what finish() has not put in its place, and the folder where it was made here and is empty.
  ~Inbox();

  /// What is accepted from now on.
  void expect(const Wanted& wanted);

  /// Takes the dataset that follows a C-STORE request, and returns the status to answer with. Throws ArchiveError where
  /// the disk is full or a limit is passed, Cancelled where keep_going says so; then the association has to be aborted,
  /// for its dataset was not read to its end. A connection that breaks is told by `broken`.
  std::uint16_t store(T_ASC_Association& association, Watch& watch, int silence_s, const Command& command,
                      const KeepGoing& keep_going, OFCondition& broken);

  std::size_t files() const noexcept { return files_.load(std::memory_order_relaxed); }
  std::uint64_t bytes() const noexcept { return bytes_.load(std::memory_order_relaxed); }
  /// Of all datasets, also of the one that is on its way and of those that are not kept.
  std::uint64_t received_bytes() const noexcept { return received_bytes_.load(std::memory_order_relaxed); }
  /// Objects of another study or series, which were not kept.
  std::size_t unasked() const noexcept { return unasked_.load(std::memory_order_relaxed); }

  /// Puts all that came in its place.
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
