#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "io/dicom/dcmtk_start.h"
#include "io/dicom/file_header.h"
#include "io/dicom/file_kind.h"
#include "io/dicom/grouping.h"
#include "io/dicom/velocity.h"
#include "io/files_below.h"
#include "io/messages.h"
#include "io/parallel.h"
#include "io/series.h"

namespace palpate::io {
namespace fs = std::filesystem;
namespace {

struct KnownFile {
  std::string sop_class;  ///< UID; empty where it is not DICOM
  std::string image_type;
};

void name_kinds(const std::map<fs::path, KnownFile>& known, std::vector<SkippedFile>& skipped) {
  for (SkippedFile& file : skipped) {
    const auto found = known.find(file.path);
    const KnownFile is = found == known.end() ? KnownFile() : found->second;
    file.kind = internal::kind_of_file(is.sop_class, is.image_type, file.reason);
  }
}

// As a radiologist's list has them: study by study, each in the order of the scanner's numbers.
void sort_series(std::vector<Series>& series) {
  std::stable_sort(series.begin(), series.end(), [](const Series& a, const Series& b) {
    const auto place_of = [](const Series& s) {
      return std::tuple(!s.usable, s.identity.study_date, s.study_uid, !s.details.number, s.details.number.value_or(0));
    };
    return place_of(a) < place_of(b);
  });
}

}  // namespace

Catalogue find_series(std::span<const fs::path> paths, const Progress& progress) {
  internal::start_dcmtk();
  Catalogue catalogue;
  const std::vector<fs::path> files = internal::files_below(paths, catalogue.skipped);

  std::vector<std::optional<internal::FileHeader>> headers(files.size());
  std::vector<Text> reasons(files.size());
  std::vector<KnownFile> known(files.size());
  internal::parallel_for(
      files.size(),
      [&](std::size_t i) {
        try {
          headers[i] = internal::read_file_header(files[i]);
          known[i] = {headers[i]->sop_class, headers[i]->image_type};
        } catch (const internal::NotAnImage& error) {
          reasons[i] = error.text();
          known[i].sop_class = error.sop_class;
        } catch (const Refusal& error) {
          reasons[i] = error.text();
        } catch (const std::exception& error) {
          reasons[i] = say("file-cannot-be-read", error.what());
        }
      },
      progress, 0);

  std::vector<internal::FileHeader> images;
  std::map<fs::path, KnownFile> known_files;
  for (std::size_t i = 0; i < files.size(); ++i) {
    known_files.emplace(files[i], std::move(known[i]));
    if (headers[i]) {
      images.push_back(std::move(*headers[i]));
    } else {
      catalogue.skipped.push_back({files[i], reasons[i]});
    }
  }
  catalogue.series = internal::group_into_series(std::move(images), catalogue.skipped);
  sort_series(catalogue.series);
  catalogue.velocity_fields = internal::join_velocities(catalogue.series);
  name_kinds(known_files, catalogue.skipped);
  std::sort(catalogue.skipped.begin(), catalogue.skipped.end(),
            [](const SkippedFile& a, const SkippedFile& b) { return a.path < b.path; });
  return catalogue;
}

}  // namespace palpate::io
