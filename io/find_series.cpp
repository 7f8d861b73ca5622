#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "io/dicom/dcmtk_start.h"
#include "io/dicom/file_header.h"
#include "io/dicom/file_kind.h"
#include "io/dicom/grouping.h"
#include "io/dicom/series_source.h"
#include "io/dicom/velocity.h"
#include "io/errors.h"
#include "io/files_below.h"
#include "io/interchange/voxel_scan.h"
#include "io/messages.h"
#include "io/parallel.h"
#include "io/series.h"
#include "io/structures/structure_file.h"
#include "io/unpack.h"

namespace palpate::io {
namespace fs = std::filesystem;
namespace {

struct KnownFile {
  std::string sop_class;  ///< UID; empty where it is not DICOM
  std::string image_type;
};

/// A file's path as shown to the user, and the file with its bytes.
struct File {
  fs::path path, stored_at;
  std::shared_ptr<const void> keeper;  ///< of what was unpacked
};

/// The type of a file: an image, a skipped file with a reason, or an archive whose files are examined instead.
struct Looked {
  File file;
  std::optional<internal::FileHeader> header;
  std::optional<Series> series;  ///< of NIfTI, NRRD, MetaImage
  Text reason;
  KnownFile known;
  bool is_archive = false;

  bool is_known() const { return header || series || reason != say("not-a-dicom-file"); }
};

// NIfTI and similar files. In a folder such a file may be a label map beside its scan; a file named by the user is a
// scan.
void look_for_voxels(Looked& one, bool is_named) {
  std::optional<VoxelFile> file = open_voxel_file(one.file.stored_at, one.file.path);
  if (!file) return;
  check_size(*file);
  one.reason = Text();
  const bool is_labels = is_label_map(*file);
  if (is_labels && !is_named) {
    one.reason = say("a-label-map");
    return;
  }
  one.series = series_of(std::move(*file), one.file.path, one.file.keeper);
  if (is_labels) one.series->warnings.push_back(say("values-look-like-labels"));
}

void look_at_header(Looked& one) {
  try {
    one.header = internal::read_file_header(one.file.stored_at);
    one.header->path = one.file.path;
    one.header->keeper = one.file.keeper;
    one.known = {one.header->sop_class, one.header->image_type};
  } catch (const internal::NotAnImage& error) {
    one.reason = error.text();
    one.known.sop_class = error.sop_class;
  } catch (const Refusal& error) {
    one.reason = error.text();
  } catch (const std::exception& error) {
    one.reason = say("file-cannot-be-read", error.what());
  }
}

void look_at(Looked& one, std::span<const fs::path> named) {
  look_at_header(one);
  if (one.is_known()) return;
  try {
    look_for_voxels(one, std::ranges::find(named, one.file.path) != named.end());
    one.is_archive = !one.is_known() && internal::is_archive(one.file.stored_at);
  } catch (const Refusal& error) {
    one.reason = error.text();
  } catch (const std::exception& error) {
    one.reason = say("file-cannot-be-read", error.what());
  }
}

void look_at_all(std::vector<Looked>& all, std::span<const fs::path> named, const Progress& progress) {
  internal::parallel_for(
      all.size(), [&](std::size_t i) { look_at(all[i], named); }, progress, 0);
}

// The scans in an archive; its other files are not spoken of.
std::vector<Looked> look_into(Looked& archive, const Progress& progress) {
  std::vector<Looked> inside;
  try {
    const auto unpacked = internal::unpack(archive.file.stored_at, progress);
    for (const internal::Unpacked::File& file : unpacked->files) {
      inside.push_back({{archive.file.path / file.shown, file.stored_at, unpacked}, {}, {}, {}, {}, false});
    }
    look_at_all(inside, {}, progress);
    std::erase_if(inside, [](const Looked& one) { return !one.is_known(); });
    std::ranges::sort(inside, {}, [](const Looked& one) { return one.file.path; });
    archive.reason = inside.empty() ? say("archive-holds-no-scan") : Text();
  } catch (const DicomError& error) {
    archive.reason = error.text();
  }
  return inside;
}

/// Examines all files, including those in archives.
std::vector<Looked> look_at_files(const std::vector<fs::path>& files, std::span<const fs::path> named,
                                  const Progress& progress) {
  std::vector<Looked> all;
  all.reserve(files.size());
  for (const fs::path& file : files) all.push_back({{file, file, nullptr}, {}, {}, {}, {}, false});
  look_at_all(all, named, progress);
  const auto still_done = [&](double) { return progress(1); };  // progress never goes back
  std::vector<Looked> unpacked;
  for (Looked& one : all) {
    if (!one.is_archive) continue;
    std::vector<Looked> inside = look_into(one, progress ? Progress(still_done) : Progress());
    std::move(inside.begin(), inside.end(), std::back_inserter(unpacked));
  }
  std::move(unpacked.begin(), unpacked.end(), std::back_inserter(all));
  return all;
}

// By their paths as text: comparing paths takes them apart.
using KnownFiles = std::unordered_map<std::string, KnownFile>;

void name_kinds(const KnownFiles& known, std::vector<SkippedFile>& skipped) {
  for (SkippedFile& file : skipped) {
    const auto found = known.find(file.path.native());
    const KnownFile is = found == known.end() ? KnownFile() : found->second;
    file.kind = internal::kind_of_file(is.sop_class, is.image_type, file.reason);
  }
}

// As a radiologist's list has them: study by study, each in the order of the scanner's numbers.
void sort_series(std::vector<Series>& series) {
  std::stable_sort(series.begin(), series.end(), [](const Series& a, const Series& b) {
    const auto place_of = [](const Series& s) {
      const bool is_dicom = !s.source || !s.source->voxel_file;
      return std::tuple(!s.usable, !is_dicom, s.identity.study_date, s.study_uid, !s.details.number,
                        s.details.number.value_or(0));
    };
    return place_of(a) < place_of(b);
  });
}

}  // namespace

Catalogue find_series(std::span<const fs::path> paths, const Progress& progress) {
  internal::start_dcmtk();
  Catalogue catalogue;
  std::vector<internal::FileHeader> images;
  std::vector<Series> others;
  KnownFiles known_files;
  for (Looked& one : look_at_files(internal::files_below(paths, catalogue.skipped, progress), paths, progress)) {
    known_files.emplace(one.file.path.native(), std::move(one.known));
    if (one.header) {
      images.push_back(std::move(*one.header));
    } else if (one.series) {
      others.push_back(std::move(*one.series));
    } else if (!one.reason.empty()) {
      catalogue.skipped.push_back({one.file.path, one.reason});
    }
  }
  catalogue.series = internal::group_into_series(std::move(images), catalogue.skipped);
  std::move(others.begin(), others.end(), std::back_inserter(catalogue.series));
  sort_series(catalogue.series);
  catalogue.velocity_fields = internal::join_velocities(catalogue.series);
  name_kinds(known_files, catalogue.skipped);
  std::sort(catalogue.skipped.begin(), catalogue.skipped.end(),
            [](const SkippedFile& a, const SkippedFile& b) { return a.path < b.path; });
  return catalogue;
}

}  // namespace palpate::io
