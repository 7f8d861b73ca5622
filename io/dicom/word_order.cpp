#include "io/dicom/word_order.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace palpate::io::internal {
namespace {

constexpr std::size_t number_bytes = 4;

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t n, bool as_wholes) {
  const auto half = [&](std::size_t at) {
    return std::to_integer<std::uint32_t>(bytes[at]) << 8 | std::to_integer<std::uint32_t>(bytes[at + 1]);
  };
  const std::uint32_t first = half(n * number_bytes), second = half(n * number_bytes + 2);
  return as_wholes ? first << 16 | second : second << 16 | first;
}

/// What speaks against an order.
struct Doubts {
  std::uint64_t outside = 0;  ///< numbers with bits that are not stored
  double roughness = 0;       ///< differences of neighbors
  double size = 0;            ///< of the numbers, compared last: counts and doses are small

  auto all() const { return std::tuple(outside, roughness, size); }
};

void add_frame(const PixelFormat& format, std::span<const std::byte> bytes, bool as_wholes, Doubts& doubts) {
  const std::uint64_t stored = ((std::uint64_t{1} << format.bits_stored) - 1)
                               << (format.high_bit + 1 - format.bits_stored);
  const auto above = static_cast<std::uint32_t>(~((std::uint64_t{2} << format.high_bit) - 1));
  double last = 0;
  for (std::size_t n = 0; n < bytes.size() / number_bytes; ++n) {
    const std::uint32_t word = word_at(bytes, n, as_wholes);
    const auto unstored = static_cast<std::uint32_t>(word & ~stored);
    const bool is_negative = format.is_signed && (word >> format.high_bit & 1U) != 0;
    if (unstored != 0 && !(is_negative && unstored == above)) ++doubts.outside;
    const double value =
        format.is_signed ? static_cast<double>(static_cast<std::int32_t>(word)) : static_cast<double>(word);
    if (n > 0) doubts.roughness += std::abs(value - last);
    doubts.size += std::abs(value);
    last = value;
  }
}

}  // namespace

bool swapped_as_wholes(const InputFile& file, const FileHeader& header, std::size_t frames) {
  constexpr std::size_t most_bytes = std::size_t{1} << 26;
  std::vector<std::byte> frame(header.format.bytes_per_frame());
  const std::size_t stride = std::max<std::size_t>(1, frames * frame.size() / most_bytes);
  Doubts as_words, as_wholes;
  for (std::size_t f = 0; f < frames; f += stride) {
    file.read(header.pixels_at + f * frame.size(), frame);
    add_frame(header.format, frame, false, as_words);
    add_frame(header.format, frame, true, as_wholes);
  }
  return as_wholes.all() < as_words.all();
}

}  // namespace palpate::io::internal
