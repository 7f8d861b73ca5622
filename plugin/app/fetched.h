#pragma once

/// The folder for series that were fetched from archives; it is private to the user. What `palpate fetch` left there
/// stays until it is emptied; what the panel fetched is deleted when the panel's program ends.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace palpate::plugin {

/// $XDG_CACHE_HOME/palpate/fetched, or the same under ~/.cache: for all fetches that name no other folder.
std::filesystem::path fetched_folder();

struct OnDisk {
  std::size_t series = 0;
  std::uint64_t bytes = 0;
};
OnDisk fetched_on_disk();
/// Deletes everything there except what a running program has fetched for itself. Throws InputRefused that names what
/// cannot be deleted.
void empty_fetched();

/// The fetches of one run of a program. If a run ended without cleaning up, the next one deletes its fetches.
class FetchedRun {
 public:
  FetchedRun() = default;
  FetchedRun(const FetchedRun&) = delete;
  FetchedRun& operator=(const FetchedRun&) = delete;
  /// As close(), and never throws.
  ~FetchedRun();

  /// A folder for the next fetch; it does not exist yet, and will be readable by its owner alone. Throws InputRefused
  /// that names what cannot be written.
  std::filesystem::path next_folder();
  /// Whether a file or folder is in this run's folder.
  bool holds(const std::filesystem::path& path) const;
  /// Whether the fetched files stay when the run ends.
  void set_kept(bool kept) { kept_ = kept; }
  /// Deletes everything there, as empty_fetched() does, and the fetches of this run except those that contain something
  /// `in_use`.
  void empty(const std::vector<std::filesystem::path>& in_use);
  /// Ends the run: deletes its folder. Fetches to be kept move to the folder of `palpate fetch`.
  void close();

 private:
  std::filesystem::path folder_;
  int lock_ = -1;  // held as long as the run lasts
  int count_ = 0;
  bool kept_ = false;
};

}  // namespace palpate::plugin
