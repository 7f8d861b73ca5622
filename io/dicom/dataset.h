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

/// The position and encoding of a file's dataset.
struct DatasetStart {
  std::uint64_t at = 0;
  Encoding encoding;
  bool deflated = false;
  std::string transfer_syntax;  ///< UID
};

/// Reads preamble and file meta information (PS3.10 7.1); files without them are recognized by their first element.
/// Throws DicomError ("not a DICOM file", "empty file") for all other files, because a parser would read a text or
/// picture as thousands of attributes.
DatasetStart find_dataset(const InputFile& file);

/// The uncompressed bytes of a deflated dataset, inflated as they are read.
std::unique_ptr<ByteSource> inflated(const std::filesystem::path& path, const DatasetStart& start);

/// Checks that the part before the pixel data is safe to parse, then reads the wanted attributes into `dataset`.
/// Returns the position of the pixel data (in the inflated dataset, if it is deflated); nothing if there is none.
/// Throws DicomError.
std::optional<PixelElement> parse_header(const InputFile& file, const std::filesystem::path& path,
                                         const DatasetStart& start, DcmDataset& dataset,
                                         bool (*wants)(std::uint32_t tag) = is_asked_for);

/// The sequence in a value that was written without its VR (implicit VR, little endian; PS3.5 6.2.2). `value` excludes
/// tag and length. Null if the bytes are no sequence.
std::unique_ptr<DcmSequenceOfItems> sequence_in(std::span<const std::byte> value);

}  // namespace palpate::io::internal
