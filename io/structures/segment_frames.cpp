#include "io/structures/segment_frames.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcxfer.h>

#include <algorithm>
#include <array>
#include <utility>

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

}  // namespace

void FrameReader::inflate(std::uint64_t at, std::span<std::byte> bytes) {
  if (!bytes.empty() && inflated_ && at + 1 == inflated_to_) {
    bytes.front() = last_;
    bytes = bytes.subspan(1);
    ++at;
  }
  if (bytes.empty()) return;
  if (!inflated_ || at < inflated_to_) {
    inflated_ = internal::inflated(pixels_.path, pixels_.start);
    inflated_to_ = 0;
  }
  if (!inflated_->skip(at - inflated_to_) || inflated_->read(bytes) != bytes.size()) {
    inflated_.reset();
    throw DicomError(say("truncated-its-deflated-pixels-end-early"));
  }
  inflated_bytes_ += at - inflated_to_ + bytes.size();
  inflated_to_ = at + bytes.size();
  last_ = bytes.back();
}

std::vector<std::byte> FrameReader::read_bytes(std::uint64_t offset, std::uint64_t count) {
  if (pixels_.swapped_words) {
    const std::uint64_t lead = offset % 2;
    std::vector<std::byte> words(lead + count + (lead + count) % 2);
    file_.read(pixels_.at + offset - lead, words);
    for (std::size_t n = 0; n < words.size(); n += 2) std::swap(words[n], words[n + 1]);
    const auto first = words.begin() + static_cast<std::ptrdiff_t>(lead);
    return {first, first + static_cast<std::ptrdiff_t>(count)};
  }
  std::vector<std::byte> bytes(count);
  if (pixels_.coding == PixelCoding::deflated) {
    inflate(pixels_.at + offset, bytes);
  } else {
    file_.read(pixels_.at + offset, bytes);
  }
  return bytes;
}

/// PS3.5 8.1.1: bits follow each other from frame to frame, the least significant of a byte first.
void FrameReader::read_bits(std::uint32_t frame, std::span<std::uint16_t> values) {
  const std::uint64_t first = frame * pixels_of(pixels_.format);
  const std::uint64_t last = first + values.size() - 1;
  const std::vector<std::byte> bytes = read_bytes(first / 8, last / 8 - first / 8 + 1);
  for (std::size_t n = 0; n < values.size(); ++n) {
    const std::uint64_t bit = first % 8 + n;
    values[n] = std::to_integer<unsigned>(bytes[bit / 8]) >> (bit % 8) & 1U;
  }
}

void FrameReader::read_words(std::uint32_t frame, std::span<std::uint16_t> values) {
  const bool wide = pixels_.format.bits_allocated == 16;
  const std::uint64_t size = values.size() * (wide ? 2 : 1);
  const std::vector<std::byte> bytes = read_bytes(frame * size, size);
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (wide) {
      const auto low = std::to_integer<unsigned>(bytes[2 * n + (pixels_.big_endian ? 1 : 0)]);
      const auto high = std::to_integer<unsigned>(bytes[2 * n + (pixels_.big_endian ? 0 : 1)]);
      values[n] = static_cast<std::uint16_t>(high << 8U | low);
    } else {
      values[n] = std::to_integer<std::uint16_t>(bytes[n]);
    }
  }
}

void FrameReader::read_encapsulated(std::uint32_t frame, std::span<std::uint16_t> values) {
  const auto bytes = internal::read_fragments(file_, pixels_.fragments.at(frame));
  const PixelFormat& format = pixels_.format;
  // What packs bytes packs the bits eight to a byte (PS3.5 8.2.2 and 8.2.16); coders of images know bytes alone.
  if (format.bits_allocated == 1 && internal::is_packed(pixels_.start.transfer_syntax)) {
    PixelFormat packed = as_bytes(format);
    packed.columns = static_cast<int>((pixels_of(format) + 7) / 8);
    packed.rows = 1;
    std::vector<std::uint16_t> eights(static_cast<std::size_t>(packed.columns));
    internal::decode_frame(pixels_.start.transfer_syntax, packed, bytes, eights);
    for (std::size_t n = 0; n < values.size(); ++n) {
      values[n] = static_cast<std::uint16_t>(eights[n / 8] >> (n % 8) & 1U);
    }
    return;
  }
  internal::decode_frame(pixels_.start.transfer_syntax, format.bits_allocated == 1 ? as_bytes(format) : format, bytes,
                         values);
}

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
  pixels.swapped_words = pixels.big_endian && format.bits_allocated <= 8 && element.vr == "OW";
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

void FrameReader::read(std::uint32_t frame, std::span<std::uint16_t> values) {
  if (pixels_.coding == PixelCoding::encapsulated) {
    read_encapsulated(frame, values);
  } else if (pixels_.format.bits_allocated == 1) {
    read_bits(frame, values);
  } else {
    read_words(frame, values);
  }
}

}  // namespace palpate::io
