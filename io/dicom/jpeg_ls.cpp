#include <charls/charls.h>

#include <algorithm>
#include <vector>

#include "io/dicom/decode.h"
#include "io/errors.h"

namespace palpate::io::internal {

void decode_jpeg_ls(const PixelFormat& format, std::span<const std::byte> bytes, std::span<std::uint16_t> values) {
  try {
    const charls::jpegls_decoder decoder(bytes.data(), bytes.size(), true);
    const charls::frame_info& frame = decoder.frame_info();
    // Before anything is decoded: its own header decides how much memory that takes.
    if (frame.width != static_cast<std::uint32_t>(format.columns) ||
        frame.height != static_cast<std::uint32_t>(format.rows) || frame.component_count != 1) {
      throw DicomError("damaged: its JPEG-LS image is of another size than the file says");
    }
    if (frame.bits_per_sample > 8) {
      decoder.decode(values.data(), values.size_bytes());
    } else {
      std::vector<std::uint8_t> small(values.size());
      decoder.decode(small.data(), small.size());
      std::copy(small.begin(), small.end(), values.begin());
    }
  } catch (const charls::jpegls_error& error) {
    throw DicomError(std::string("damaged: its JPEG-LS image cannot be decoded (") + error.what() + ")");
  }
}

}  // namespace palpate::io::internal
