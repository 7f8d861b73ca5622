#pragma once

/// Who and what a series is of, as its images say it, to be copied into what is made of it. Not installed.

#include <string>
#include <utility>
#include <vector>

#include "io/series.h"

class DcmItem;

namespace palpate::io {

struct ReferencedImage {
  std::string sop_class, instance;
};

struct StudyHeader {
  /// Attributes of patient and study in UTF-8: group and element, value; empty ones where the standard wants them
  /// there.
  std::vector<std::pair<std::uint32_t, std::string>> attributes;
  std::string study_uid, series_uid, frame_of_reference_uid;
  std::vector<ReferencedImage> images;
};

/// Throws DicomError naming the file that cannot be read, or what the series lacks.
StudyHeader read_study_header(const Series& series);

/// Puts them into a dataset, which is then in UTF-8.
void put_study(const StudyHeader& header, DcmItem& dataset);

}  // namespace palpate::io
