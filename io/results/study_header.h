#pragma once

/// Patient and study of a series, from its images, to be copied into new objects. Not installed.

#include <string>
#include <utility>
#include <vector>

#include "io/series.h"

class DcmItem;

namespace palpate::io {

struct ReferencedImage {
  std::string sop_class, instance;
  std::string series_uid;  ///< the image's own: a scan may be joined from several series
};

struct StudyHeader {
  /// Attributes of patient and study: group and element, and the value in UTF-8. Attributes that the standard requires
  /// are there even if empty.
  std::vector<std::pair<std::uint32_t, std::string>> attributes;
  std::string study_uid, series_uid, frame_of_reference_uid;  ///< of the first image
  std::vector<ReferencedImage> images;
};

/// Throws DicomError that names the file that cannot be read, or the attribute that the series lacks.
StudyHeader read_study_header(const Series& series);

/// Adds them to a dataset, whose character set becomes UTF-8.
void put_study(const StudyHeader& header, DcmItem& dataset);

}  // namespace palpate::io
