#pragma once

/// Shared by all DICOM objects that we write. Not installed.

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>

#include <cstdint>
#include <string>
#include <vector>

#include "io/results/study_header.h"
#include "io/series.h"
#include "io/structures/label_image.h"

namespace palpate::io {

inline constexpr const char* not_a_device = "Made by research software, which is not a medical device.";

std::string new_uid();

/// A number as a DICOM decimal string (DS), with as many digits as fit into 16 bytes.
std::string decimal(double number);

/// One line of at most 64 characters (LO): without backslashes and control characters.
std::string long_string(const std::string& utf8);

/// The object as the bytes of a file. Throws DicomError if DCMTK refuses.
std::string bytes_of(DcmFileFormat& format, E_TransferSyntax syntax);

/// Throws DicomError with DCMTK's reason.
void succeed(const OFCondition& condition);

/// The image that lies on a slice.
struct SliceImage {
  ReferencedImage image;    ///< without an instance if there is no image
  std::uint32_t frame = 0;  ///< of a multi-frame file, from 1 on; else 0
};

/// One for each slice of the scan's frame, found by their positions. Throws DicomError if the scan is not DICOM.
std::vector<SliceImage> images_of_slices(const Series& scan, const Geometry& geometry, int frame);

/// Adds a code sequence with one item.
void put_code(DcmItem& item, const DcmTagKey& sequence, const Code& code);
/// The code of an item of such a sequence.
void put_code(DcmItem& item, const Code& code);

/// Adds the shared attributes: patient and study, a new series and instance, equipment, dates, and the corrected
/// object.
void put_common(const StudyHeader& header, const StructureLabel& label, const Series& scan, const WriteOptions& options,
                DcmDataset& data);

}  // namespace palpate::io
