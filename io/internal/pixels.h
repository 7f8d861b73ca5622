#pragma once

#include <cstdint>
#include <span>

#include "palpate/io/internal/file_header.h"

namespace palpate::io::internal {

/// The stored values of one frame of a file, rows * columns of them, sign and bits as PixelFormat says (bits above
/// HighBit and below BitsStored, such as overlays, are removed). A signed value is to be read as int16. Throws
/// DicomError with a reason that does not name the file.
void read_stored_values(const FileHeader& header, std::uint32_t frame, std::span<std::uint16_t> values);

}  // namespace palpate::io::internal
