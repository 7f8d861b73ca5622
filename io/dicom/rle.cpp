// RLE lossless, PS3.5 annex G: a segment for each byte of a pixel, the most significant first, each packed as in TIFF.
#include <algorithm>
#include <string>
#include <vector>

#include "io/dicom/decode.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

[[noreturn]] void refuse_rle(const Text& why) {
  throw DicomError(say("rle", why));
}

std::size_t little_endian(std::span<const std::byte> bytes, std::size_t at) {
  std::size_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | std::to_integer<std::size_t>(bytes[at + i]);
  return value;
}

void unpack(std::span<const std::byte> packed, std::span<std::uint8_t> bytes) {
  std::size_t from = 0;
  std::size_t to = 0;
  while (to < bytes.size()) {
    if (from >= packed.size()) refuse_rle(say("rle-ends-early"));
    const auto code = std::to_integer<std::size_t>(packed[from++]);
    if (code == 128) continue;
    const bool run = code > 128;
    const std::size_t count = run ? 257 - code : code + 1;
    const std::size_t used = run ? 1 : count;
    if (used > packed.size() - from || count > bytes.size() - to) refuse_rle(say("rle-does-not-fit"));
    for (std::size_t i = 0; i < count; ++i) bytes[to + i] = std::to_integer<std::uint8_t>(packed[from + (run ? 0 : i)]);
    from += used;
    to += count;
  }
}

}  // namespace

std::vector<std::byte> unpack_rle(const PixelFormat& format, std::span<const std::byte> bytes) {
  constexpr std::size_t header_size = 64;
  const auto segments = static_cast<std::size_t>(format.bits_allocated / 8);
  if (bytes.size() < header_size) refuse_rle(say("rle-is-missing"));
  if (little_endian(bytes, 0) != segments) refuse_rle(say("rle-not-one-a-byte"));
  std::vector<std::byte> pixels(format.bytes_per_frame());
  std::vector<std::uint8_t> segment(pixels.size() / segments);
  for (std::size_t s = 0; s < segments; ++s) {
    const std::size_t start = little_endian(bytes, 4 + 4 * s);
    const std::size_t end = s + 1 < segments ? little_endian(bytes, 8 + 4 * s) : bytes.size();
    if (start < header_size || start > end || end > bytes.size()) refuse_rle(say("rle-outside-the-file"));
    unpack(bytes.subspan(start, end - start), segment);
    const std::size_t at = segments - 1 - s;  // the most significant byte first
    for (std::size_t i = 0; i < segment.size(); ++i) pixels[segments * i + at] = std::byte{segment[i]};
  }
  return pixels;
}

Text decode_rle(const PixelFormat& format, std::span<const std::byte> bytes, std::span<std::uint16_t> values) {
  put_little_endian(format, unpack_rle(format, bytes), values);
  return {};
}

}  // namespace palpate::io::internal
