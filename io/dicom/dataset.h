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
/// Throws DicomError ("not a DICOM file", "empty file") for everything else, so that no text or picture reaches a
/// parser that would take it for thousands of attributes.
DatasetStart find_dataset(const InputFile& file);

/// A deflated dataset, inflated as it is read.
std::unique_ptr<ByteSource> inflated(const std::filesystem::path& path, const DatasetStart& start);

/// Reads what is wanted of all before the pixel data into `dataset`, having checked that this is safe. Returns
/// where the pixel data is (in the inflated dataset, where it is deflated); nothing where there is none. Throws
/// DicomError.
std::optional<PixelElement> parse_header(const InputFile& file, const std::filesystem::path& path,
                                         const DatasetStart& start, DcmDataset& dataset,
                                         bool (*wants)(std::uint32_t tag) = is_asked_for);

/// The sequence that these bytes are, where they were written without their VR (implicit VR, little endian; PS3.5
/// 6.2.2): the value alone, without tag and length. Null where they are none.
std::unique_ptr<DcmSequenceOfItems> sequence_in(std::span<const std::byte> value);

}  // namespace palpate::io::internal
