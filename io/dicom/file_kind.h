#pragma once

/// The kind of a file, in a radiologist's words.

#include <string>

#include "io/errors.h"

namespace palpate::io::internal {

/// A file that holds no image: a report, a plan, a structure set.
class NotAnImage : public DicomError {
 public:
  NotAnImage(const Text& reason, std::string sop_class_uid) : DicomError(reason), sop_class(std::move(sop_class_uid)) {}
  std::string sop_class;  ///< UID; may be empty
};

/// "structured report", "scout", "segmentation", ... `sop_class` (UID) and `image_type` are empty if the file is not
/// DICOM; `reason` is why the file was skipped.
std::string kind_of_file(const std::string& sop_class, const std::string& image_type, const std::string& reason);

}  // namespace palpate::io::internal
