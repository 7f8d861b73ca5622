#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <system_error>

#include "io/dicom/dcmtk_start.h"
#include "io/dicom/file_header.h"
#include "io/dicom/grouping.h"
#include "io/dicom/velocity.h"
#include "io/errors.h"
#include "io/parallel.h"
#include "io/series.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;

// A DICOMDIR that is named itself stands for the folder it describes; what it says of that folder is not believed.
fs::path meant_by(const fs::path& path) {
  std::string name = path.filename().string();
  for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name == "DICOMDIR" ? fs::absolute(path).parent_path() : path;
}

// Links to folders are not followed: they may lead in a circle.
std::vector<fs::path> files_below(std::span<const fs::path> paths, std::vector<SkippedFile>& skipped) {
  std::vector<fs::path> files;
  for (const fs::path& named : paths) {
    std::error_code error;
    if (!fs::exists(named, error)) throw DicomError("no such file or folder: " + named.string() + "; check its name");
    const fs::path path = fs::is_regular_file(named, error) ? meant_by(named) : named;
    const auto status = fs::status(path, error);
    if (fs::is_regular_file(status)) files.push_back(path);
    if (!fs::is_directory(status)) continue;
    // Folders below that may not be read are set apart; the one that was named is refused.
    static_cast<void>(fs::directory_iterator(path, error));
    auto entry = fs::recursive_directory_iterator();
    if (!error) entry = {path, fs::directory_options::skip_permission_denied, error};
    for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
      std::error_code ignored;
      if (entry->is_regular_file(ignored)) files.push_back(entry->path());
      if (entry->is_directory(ignored) && ::eaccess(entry->path().c_str(), R_OK | X_OK) != 0) {
        skipped.push_back({entry->path(), "a folder that may not be read: ask for the right to it"});
      }
    }
    if (error)
      throw DicomError("cannot list " + path.string() + ": " + error.message() + "; it has to be yours to read");
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

}  // namespace

Catalogue find_series(std::span<const fs::path> paths, const Progress& progress) {
  internal::start_dcmtk();
  Catalogue catalogue;
  const std::vector<fs::path> files = files_below(paths, catalogue.skipped);

  std::vector<std::optional<internal::FileHeader>> headers(files.size());
  std::vector<std::string> reasons(files.size());
  internal::parallel_for(
      files.size(),
      [&](std::size_t i) {
        try {
          headers[i] = internal::read_file_header(files[i]);
        } catch (const std::exception& error) {
          reasons[i] = error.what();
        }
      },
      progress, 0);

  std::vector<internal::FileHeader> images;
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (headers[i]) {
      images.push_back(std::move(*headers[i]));
    } else {
      catalogue.skipped.push_back({files[i], reasons[i]});
    }
  }
  catalogue.series = internal::group_into_series(std::move(images), catalogue.skipped);
  std::stable_partition(catalogue.series.begin(), catalogue.series.end(), [](const Series& s) { return s.usable; });
  catalogue.velocity_fields = internal::join_velocities(catalogue.series);
  std::sort(catalogue.skipped.begin(), catalogue.skipped.end(),
            [](const SkippedFile& a, const SkippedFile& b) { return a.path < b.path; });
  return catalogue;
}

}  // namespace palpate::io
