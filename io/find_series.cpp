#include <algorithm>
#include <optional>
#include <string>

#include "io/dicom/dcmtk_start.h"
#include "io/dicom/file_header.h"
#include "io/dicom/grouping.h"
#include "io/dicom/velocity.h"
#include "io/files_below.h"
#include "io/parallel.h"
#include "io/series.h"

namespace palpate::io {
namespace fs = std::filesystem;

Catalogue find_series(std::span<const fs::path> paths, const Progress& progress) {
  internal::start_dcmtk();
  Catalogue catalogue;
  const std::vector<fs::path> files = internal::files_below(paths, catalogue.skipped);

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
