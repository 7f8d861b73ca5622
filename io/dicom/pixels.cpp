#include "io/dicom/pixels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "io/dicom/dataset.h"
#include "io/dicom/decode.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

void swap_bytes(std::span<std::uint16_t> values) {
  for (auto& v : values) v = static_cast<std::uint16_t>(v << 8 | v >> 8);
}

// Brings the stored bits down to bit 0 and extends the sign.
std::uint16_t cleaned(std::uint16_t v, int above, int unused, bool is_signed) {
  v = static_cast<std::uint16_t>(v << above);
  return is_signed ? static_cast<std::uint16_t>(static_cast<std::int16_t>(v) >> unused)
                   : static_cast<std::uint16_t>(v >> unused);
}

void clean_bits(const FileHeader& header, std::span<std::uint16_t> values) {
  const PixelFormat& format = header.format;
  if (format.bits_stored == 16) return;
  const int above = 15 - format.high_bit;
  const int unused = 16 - format.bits_stored;
  if (header.padding_is_wide()) {
    // A word of 16 bits that means no value: without its upper bits it would be one (-32768 in 12 bits: 0).
    for (auto& v : values) {
      const double word = format.is_signed ? static_cast<std::int16_t>(v) : v;
      const bool is_padding = word >= header.padding->first && word <= header.padding->second;
      if (!is_padding) v = cleaned(v, above, unused, format.is_signed);
    }
  } else if (format.is_signed) {
    for (auto& v : values) v = cleaned(v, above, unused, true);
  } else {
    for (auto& v : values) v = cleaned(v, above, unused, false);
  }
}

// Of big-endian files: floating-point numbers are swapped as wholes, of integers each word of 16 bits by itself (PS3.5
// 7.3), unless their writer swapped them as wholes, too.
void swap_within(std::span<std::byte> bytes, std::size_t unit) {
  for (std::size_t at = 0; at + unit <= bytes.size(); at += unit) {
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + unit));
  }
}

template <typename Number>
Number number_at(std::span<const std::byte> bytes, std::size_t n) {
  std::array<std::byte, sizeof(Number)> raw{};
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(n * sizeof(Number)), sizeof(Number), raw.begin());
  return std::bit_cast<Number>(raw);
}

double wide_integer(std::uint32_t word, const PixelFormat& format) {
  const auto above = static_cast<std::uint32_t>(31 - format.high_bit);
  const auto unused = static_cast<std::uint32_t>(32 - format.bits_stored);
  const std::uint32_t up = word << above;
  if (!format.is_signed) return static_cast<double>(up >> unused);
  return static_cast<double>(static_cast<std::int32_t>(up) >> unused);
}

}  // namespace

PixelReader::PixelReader(const FileHeader& header) : header_(header), file_(header.stored_at) {}

void PixelReader::read_deflated(std::uint64_t offset, std::span<std::byte> bytes) {
  const std::uint64_t at = header_.pixels_at + offset;
  if (!inflated_ || at < inflated_to_) {
    inflated_ = inflated(header_.stored_at, header_.start);
    inflated_to_ = 0;
  }
  if (!inflated_->skip(at - inflated_to_) || inflated_->read(bytes) != bytes.size()) {
    inflated_.reset();
    throw DicomError(say("truncated-its-deflated-pixels-end-early"));
  }
  inflated_to_ = at + bytes.size();
}

void PixelReader::read_uncompressed(std::uint64_t offset, std::span<std::byte> bytes) {
  if (header_.coding == PixelCoding::deflated) {
    read_deflated(offset, bytes);
  } else {
    file_.read(header_.pixels_at + offset, bytes);
  }
}

Text PixelReader::read(std::uint32_t frame, std::span<std::uint16_t> values) {
  const PixelFormat& format = header_.format;
  const std::size_t frame_bytes = format.bytes_per_frame();
  Text note;
  if (header_.coding == PixelCoding::encapsulated) {
    note = decode_frame(header_.transfer_syntax, format, read_fragments(file_, header_.fragments.at(frame)), values);
  } else if (format.bits_allocated == 16) {
    read_uncompressed(frame * frame_bytes, std::as_writable_bytes(values));
    if (header_.big_endian != (std::endian::native == std::endian::big)) swap_bytes(values);
  } else {
    // 8-bit pixels in 16-bit words: big-endian files hold the second pixel first, and a word may straddle two frames.
    const std::uint64_t start = frame * frame_bytes;
    const std::uint64_t lead = header_.swapped_words ? start % 2 : 0;
    std::vector<std::uint8_t> bytes(lead + frame_bytes + (header_.swapped_words ? (lead + frame_bytes) % 2 : 0));
    read_uncompressed(start - lead, std::as_writable_bytes(std::span(bytes)));
    for (std::size_t i = 0; header_.swapped_words && i + 1 < bytes.size(); i += 2) std::swap(bytes[i], bytes[i + 1]);
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(lead), values.size(), values.begin());
  }
  clean_bits(header_, values);
  return note;
}

void PixelReader::read_wide(std::uint32_t frame, std::span<double> values) {
  const PixelFormat& format = header_.format;
  std::vector<std::byte> bytes;
  if (header_.coding == PixelCoding::encapsulated) {
    bytes = unpack_frame(header_.transfer_syntax, format, read_fragments(file_, header_.fragments.at(frame)));
  } else {
    bytes.resize(format.bytes_per_frame());
    read_uncompressed(frame * bytes.size(), bytes);
  }
  const bool as_wholes = format.is_float || header_.swapped_wholes;
  const std::size_t number = as_wholes ? static_cast<std::size_t>(format.bits_allocated / 8) : 2;
  if (header_.big_endian) swap_within(bytes, number);
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (!format.is_float) {
      values[n] = wide_integer(number_at<std::uint32_t>(bytes, n), format);
    } else if (format.bits_allocated == 64) {
      values[n] = number_at<double>(bytes, n);
    } else {
      values[n] = static_cast<double>(number_at<float>(bytes, n));
    }
  }
}

}  // namespace palpate::io::internal
