#include "io/structures/segment_frames.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcxfer.h>

#include <algorithm>
#include <array>

#include "io/dicom/decode.h"
#include "io/dicom/fragments.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

using internal::PixelCoding;
using internal::PixelFormat;

std::uint64_t pixels_of(const PixelFormat& format) {
  return static_cast<std::uint64_t>(format.columns) * static_cast<std::uint64_t>(format.rows);
}

/// A frame of single bits as bytes: how coders of images hold it.
PixelFormat as_bytes(const PixelFormat& format) {
  PixelFormat bytes = format;
  bytes.bits_allocated = bytes.bits_stored = 8;
  bytes.high_bit = 7;
  return bytes;
}

std::vector<std::byte> read_bytes(const SegmentationPixels& pixels, std::uint64_t offset, std::uint64_t count) {
  std::vector<std::byte> bytes(count);
  if (pixels.coding == PixelCoding::deflated) {
    const auto source = internal::inflated(pixels.path, pixels.start);
    if (!source->skip(pixels.at + offset) || source->read(bytes) != bytes.size()) {
      throw DicomError(say("truncated-its-deflated-pixels-end-early"));
    }
  } else {
    internal::InputFile(pixels.path).read(pixels.at + offset, bytes);
  }
  return bytes;
}

/// PS3.5 8.1.1: bits follow each other from frame to frame, the least significant of a byte first.
void read_bits(const SegmentationPixels& pixels, std::uint32_t frame, std::span<std::uint16_t> values) {
  const std::uint64_t first = frame * pixels_of(pixels.format);
  const std::uint64_t last = first + values.size() - 1;
  const std::vector<std::byte> bytes = read_bytes(pixels, first / 8, last / 8 - first / 8 + 1);
  for (std::size_t n = 0; n < values.size(); ++n) {
    const std::uint64_t bit = first % 8 + n;
    values[n] = std::to_integer<unsigned>(bytes[bit / 8]) >> (bit % 8) & 1U;
  }
}

void read_words(const SegmentationPixels& pixels, std::uint32_t frame, std::span<std::uint16_t> values) {
  const bool wide = pixels.format.bits_allocated == 16;
  const std::uint64_t size = values.size() * (wide ? 2 : 1);
  const std::vector<std::byte> bytes = read_bytes(pixels, frame * size, size);
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (wide) {
      const auto low = std::to_integer<unsigned>(bytes[2 * n + (pixels.big_endian ? 1 : 0)]);
      const auto high = std::to_integer<unsigned>(bytes[2 * n + (pixels.big_endian ? 0 : 1)]);
      values[n] = static_cast<std::uint16_t>(high << 8U | low);
    } else {
      values[n] = std::to_integer<std::uint16_t>(bytes[n]);
    }
  }
}

void read_encapsulated(const SegmentationPixels& pixels, std::uint32_t frame, std::span<std::uint16_t> values) {
  const internal::InputFile file(pixels.path);
  const auto bytes = internal::read_fragments(file, pixels.fragments.at(frame));
  const PixelFormat& format = pixels.format;
  // What packs bytes packs the bits eight to a byte (PS3.5 8.2.2 and 8.2.16); coders of images know bytes alone.
  if (format.bits_allocated == 1 && internal::is_packed(pixels.start.transfer_syntax)) {
    PixelFormat packed = as_bytes(format);
    packed.columns = static_cast<int>((pixels_of(format) + 7) / 8);
    packed.rows = 1;
    std::vector<std::uint16_t> eights(static_cast<std::size_t>(packed.columns));
    internal::decode_frame(pixels.start.transfer_syntax, packed, bytes, eights);
    for (std::size_t n = 0; n < values.size(); ++n) {
      values[n] = static_cast<std::uint16_t>(eights[n / 8] >> (n % 8) & 1U);
    }
    return;
  }
  internal::decode_frame(pixels.start.transfer_syntax, format.bits_allocated == 1 ? as_bytes(format) : format, bytes,
                         values);
}

}  // namespace

SegmentationPixels find_pixels(const std::filesystem::path& path, const internal::DatasetStart& start,
                               const internal::PixelElement& element, const PixelFormat& format, std::size_t frames) {
  SegmentationPixels pixels{.path = path, .start = start, .format = format};
  if (format.columns < 1 || format.rows < 1) {
    throw DicomError(say("no-pixels-rows"));
  }
  if (element.is_float || (format.bits_allocated != 1 && format.bits_allocated != 8 && format.bits_allocated != 16)) {
    throw DicomError(say("pixels-have-bits", format.bits_allocated));
  }
  const internal::InputFile file(path);
  pixels.at = start.deflated ? element.value_at : start.at + element.value_at;
  pixels.big_endian = DcmXfer(start.transfer_syntax.c_str()).getPixelDataByteOrder() == EBO_BigEndian;
  if (element.length == internal::PixelElement::undefined_length) {
    if (!internal::can_decode(start.transfer_syntax)) {
      throw DicomError(internal::why_not_decoded(start.transfer_syntax));
    }
    pixels.coding = PixelCoding::encapsulated;
    internal::check_density(start.transfer_syntax, format.bits_allocated == 1 ? as_bytes(format) : format, frames,
                            8 * file.size());
    pixels.fragments = internal::find_fragments(file, pixels.at, frames).frames;
    return pixels;
  }
  pixels.coding = start.deflated ? PixelCoding::deflated : PixelCoding::native;
  if (start.deflated) internal::check_inflation(element.length, file.size());
  const std::uint64_t needed = (pixels_of(format) * frames * static_cast<std::uint64_t>(format.bits_allocated) + 7) / 8;
  const std::uint64_t present =
      start.deflated ? element.length
                     : std::min<std::uint64_t>(element.length, file.size() - std::min(file.size(), pixels.at));
  if (present < needed) {
    throw DicomError(say("truncated-pixels", present, needed));
  }
  return pixels;
}

void read_frame(const SegmentationPixels& pixels, std::uint32_t frame, std::span<std::uint16_t> values) {
  if (pixels.coding == PixelCoding::encapsulated) {
    read_encapsulated(pixels, frame, values);
  } else if (pixels.format.bits_allocated == 1) {
    read_bits(pixels, frame, values);
  } else {
    read_words(pixels, frame, values);
  }
}

}  // namespace palpate::io
