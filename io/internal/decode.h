#pragma once

/// One compressed frame -> stored values.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "palpate/io/internal/file_header.h"

namespace palpate::io::internal {

/// Whether images in this encapsulated transfer syntax can be decoded.
bool can_decode(const std::string& transfer_syntax);

/// Throws DicomError where `bytes` of this syntax cannot hold that many frames of that format: no coder packs pixels
/// more densely than the bound used here, so a header that claims 60000 rows in a small file costs no memory.
void check_density(const std::string& transfer_syntax, const PixelFormat& format, std::size_t frames,
                   std::uint64_t bytes);

/// Decodes one frame: `values` holds rows * columns. Throws DicomError with a reason where the stream is damaged or is
/// an image of another size than the header says.
void decode_frame(const std::string& transfer_syntax, const PixelFormat& format, std::span<const std::byte> bytes,
                  std::span<std::uint16_t> values);

/// Columns and rows that a JPEG or JPEG-LS stream claims (its SOF marker, ISO 10918-1 annex B); nothing where it has
/// none.
std::optional<std::pair<int, int>> jpeg_size(std::span<const std::byte> bytes);

/// The same for JPEG 2000, a codestream or a JP2 file, by OpenJPEG.
void decode_jpeg2000(const PixelFormat& format, std::span<const std::byte> bytes, std::span<std::uint16_t> values);

}  // namespace palpate::io::internal
