#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "io/dicom/dataset.h"
#include "io/dicom/file_header.h"
#include "io/dicom/input_file.h"

namespace palpate::io::internal {

/// Reads frames of one file. Keeps the file open. Not safe for several threads at a time.
class PixelReader {
 public:
  /// `header` has to live as long as the reader. Throws DicomError if the file cannot be opened.
  explicit PixelReader(const FileHeader& header);

  /// The stored values of a whole frame of the file (all tiles of a mosaic): rows * columns of them, sign extended.
  /// Bits outside BitsStored, such as overlays, are removed, except where padding needs them. Signed values must be
  /// read as int16. Returns the text of decode_frame(). Throws DicomError with a reason that does not name the file.
  Text read(std::uint32_t frame, std::span<std::uint16_t> values);

  /// The stored values of a frame with wide values (PixelFormat::is_wide); such frames are uncompressed, RLE or
  /// deflated. Throws DicomError as read() does.
  void read_wide(std::uint32_t frame, std::span<double> values);

 private:
  void read_uncompressed(std::uint64_t offset, std::span<std::byte> bytes);
  void read_deflated(std::uint64_t offset, std::span<std::byte> bytes);

  const FileHeader& header_;
  InputFile file_;
  // A deflated file is inflated once if its frames are read in order.
  std::unique_ptr<ByteSource> inflated_;
  std::uint64_t inflated_to_ = 0;
};

}  // namespace palpate::io::internal
