#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "io/dicom/asked_for.h"
#include "io/dicom/input_file.h"
#include "io/dicom/structure.h"

class DcmDataset;
class DcmSequenceOfItems;

namespace palpate::io::internal {

/// Where a file's dataset begins and how it is written.
struct DatasetStart {
  std::uint64_t at = 0;
  Encoding encoding;
  bool deflated = false;
  std::string transfer_syntax;  ///< UID
};

/// Reads preamble and file meta information (PS3.10 7.1); files without them are recognised by their first element.
/// Throws DicomError ("not a DICOM file", "empty file") for all other files, so that a text or a picture is not parsed
/// as thousands of attributes.
DatasetStart find_dataset(const InputFile& file);

/// A deflated dataset, which is inflated while it is read.
std::unique_ptr<ByteSource> inflated(const std::filesystem::path& path, const DatasetStart& start);

/// Reads the wanted attributes before the pixel data into `dataset`, after checks that this is safe. Returns where the
/// pixel data begins (in the inflated dataset, if it is deflated), or nothing if there is no pixel data. Throws
/// DicomError.
std::optional<PixelElement> parse_header(const InputFile& file, const std::filesystem::path& path,
                                         const DatasetStart& start, DcmDataset& dataset,
                                         bool (*wants)(std::uint32_t tag) = is_asked_for);

/// Reads these bytes, the value of an attribute without tag and length, as a sequence in implicit VR, little endian
/// (PS3.5 6.2.2). Null if they are not a sequence.
std::unique_ptr<DcmSequenceOfItems> sequence_in(std::span<const std::byte> value);

}  // namespace palpate::io::internal
