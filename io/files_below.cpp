#include "io/files_below.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <system_error>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

namespace fs = std::filesystem;

// A named DICOMDIR stands for the folder that it describes; its own records are not trusted.
fs::path meant_by(const fs::path& path) {
  std::string name = path.filename().string();
  for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name == "DICOMDIR" ? fs::absolute(path).parent_path() : path;
}

}  // namespace

// Links to folders are not followed: they may lead in a circle.
std::vector<fs::path> files_below(std::span<const fs::path> paths, std::vector<SkippedFile>& skipped,
                                  const Progress& progress) {
  std::vector<fs::path> files;
  for (const fs::path& named : paths) {
    std::error_code error;
    if (!fs::exists(named, error)) throw DicomError(say("no-such-file-or-folder", named.string()));
    const fs::path path = fs::is_regular_file(named, error) ? meant_by(named) : named;
    const auto status = fs::status(path, error);
    if (fs::is_regular_file(status)) files.push_back(path);
    if (!fs::is_directory(status)) continue;
    // An unreadable subfolder is skipped; an unreadable named folder is refused.
    static_cast<void>(fs::directory_iterator(path, error));
    auto entry = fs::recursive_directory_iterator();
    if (!error) entry = {path, fs::directory_options::skip_permission_denied, error};
    for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
      if (progress && !progress(0)) throw Cancelled();
      std::error_code ignored;
      if (entry->is_regular_file(ignored)) files.push_back(entry->path());
      if (entry->is_directory(ignored) && ::eaccess(entry->path().c_str(), R_OK | X_OK) != 0) {
        skipped.push_back({entry->path(), say("folder-that-may-not-be-read")});
      }
    }
    if (error) throw DicomError(say("cannot-list", path.string(), error.message()));
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace palpate::io::internal
