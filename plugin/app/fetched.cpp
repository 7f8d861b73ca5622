#include "plugin/app/fetched.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "plugin/app/archive_settings.h"
#include "plugin/app/errors.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;

constexpr const char* run_prefix = "run-";
constexpr const char* series_prefix = "series-";  // as io::fetch() names them

bool starts(const fs::path& path, const char* prefix) {
  return path.filename().string().starts_with(prefix);
}

/// A lock on a folder that leaves no file behind and ends with its holder. -1: another program holds it.
int lock_folder(const fs::path& folder, bool wait) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor >= 0 && flock(descriptor, wait ? LOCK_EX : LOCK_EX | LOCK_NB) == 0) return descriptor;
  if (descriptor >= 0) close(descriptor);
  return -1;
}

/// Of all of it, while a run's folder is made or others are swept away.
class WholeLock {
 public:
  WholeLock() : descriptor_(lock_folder(fetched_folder(), true)) {}
  WholeLock(const WholeLock&) = delete;
  WholeLock& operator=(const WholeLock&) = delete;
  ~WholeLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

 private:
  int descriptor_;
};

std::vector<fs::path> inside(const fs::path& folder) {
  std::vector<fs::path> all;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) all.push_back(entry.path());
  std::ranges::sort(all);
  return all;
}

void remove_whole(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  if (error) throw InputRefused(say("cannot-be-deleted", path.string(), error.message()));
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  const fs::path relative = path.lexically_normal().lexically_relative(folder.lexically_normal());
  return !relative.empty() && *relative.begin() != "..";
}

/// A run's folder, where its program has ended.
void remove_left(const fs::path& run) {
  const int lock = lock_folder(run, false);
  if (lock < 0) return;
  ::close(lock);
  remove_whole(run);
}

fs::path free_place(const std::string& name) {
  for (int n = 1;; ++n) {
    fs::path place = fetched_folder() / fmt::format("{}{:03}", name, n);
    if (!fs::exists(place)) return place;
  }
}

void make_private(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder.parent_path(), error);
  if (!error && fs::create_directory(folder, error)) fs::permissions(folder, fs::perms::owner_all, error);
  if (error) throw InputRefused(say("fetched-cannot-be-kept", folder.string(), error.message()));
}

}  // namespace

fs::path fetched_folder() {
  return user_folder("XDG_CACHE_HOME", ".cache") / "fetched";
}

OnDisk fetched_on_disk() {
  OnDisk result;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(fetched_folder(), error)) {
    if (entry.is_directory(error) && starts(entry.path(), series_prefix)) ++result.series;
    if (entry.is_regular_file(error)) result.bytes += entry.file_size(error);
  }
  return result;
}

void empty_fetched() {
  const WholeLock whole;
  for (const fs::path& one : inside(fetched_folder())) starts(one, run_prefix) ? remove_left(one) : remove_whole(one);
  std::error_code in_use;
  fs::remove(fetched_folder(), in_use);
}

FetchedRun::~FetchedRun() {
  try {
    close();
  } catch (const std::exception&) {  // the next run deletes it
  }
}

fs::path FetchedRun::next_folder() {
  if (folder_.empty()) {
    make_private(fetched_folder());
    const WholeLock whole;
    for (const fs::path& one : inside(fetched_folder())) {
      if (starts(one, run_prefix)) remove_left(one);
    }
    const fs::path folder = free_place(run_prefix);
    make_private(folder);
    lock_ = lock_folder(folder, false);
    folder_ = folder;
  }
  return folder_ / fmt::format("fetch-{:03}", ++count_);
}

bool FetchedRun::holds(const fs::path& path) const {
  return !folder_.empty() && lies_in(path, folder_);
}

void FetchedRun::empty(const std::vector<fs::path>& in_use) {
  empty_fetched();  // this run's folder is locked
  if (folder_.empty()) return;
  for (const fs::path& fetch : inside(folder_)) {
    if (std::ranges::none_of(in_use, [&](const fs::path& used) { return lies_in(used, fetch); })) remove_whole(fetch);
  }
}

void FetchedRun::close() {
  if (folder_.empty()) return;
  const fs::path folder = std::exchange(folder_, {});
  if (kept_) {
    const WholeLock whole;
    for (const fs::path& fetch : inside(folder)) {
      for (const fs::path& series : inside(fetch)) {
        std::error_code stays;
        if (starts(series, series_prefix)) fs::rename(series, free_place(series_prefix), stays);
      }
    }
  }
  ::close(std::exchange(lock_, -1));
  remove_whole(folder);
  std::error_code in_use;
  fs::remove(fetched_folder(), in_use);  // where it is empty
}

}  // namespace palpate::plugin
