// Deflated image frames (PS3.5 A.4.13): each frame is a separate RFC 1951 stream. A stream of an odd number of bytes
// may be padded by one.
#include <zlib.h>

#include <new>
#include <vector>

#include "io/dicom/decode.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {

std::vector<std::byte> inflate_frame(const PixelFormat& format, std::span<const std::byte> bytes) {
  const std::size_t needed = format.bytes_per_frame(), padded = needed + needed % 2;
  std::vector<std::byte> pixels(padded);
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  // zlib reads through a pointer that is not const, and does not write.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));  // NOLINT
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(pixels.data());
  stream.avail_out = static_cast<uInt>(pixels.size());
  const int status = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  const std::size_t got = padded - stream.avail_out;
  if (status != Z_STREAM_END || got < needed) throw DicomError(say("deflated-frame-is-damaged"));
  pixels.resize(needed);
  return pixels;
}

void put_little_endian(const PixelFormat& format, std::span<const std::byte> bytes, std::span<std::uint16_t> values) {
  const bool is_wide = format.bits_allocated == 16;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto at = [&](std::size_t n) { return std::to_integer<std::uint16_t>(bytes[n]); };
    values[i] = is_wide ? static_cast<std::uint16_t>(at(2 * i) | at(2 * i + 1) << 8) : at(i);
  }
}

Text decode_deflated_frame(const PixelFormat& format, std::span<const std::byte> bytes,
                           std::span<std::uint16_t> values) {
  put_little_endian(format, inflate_frame(format, bytes), values);
  return {};
}

}  // namespace palpate::io::internal
