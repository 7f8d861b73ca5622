#include <charls/charls.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "io/dicom/decode.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

void decode_whole(const PixelFormat& format, std::span<const std::byte> bytes, std::span<std::uint16_t> values) {
  const charls::jpegls_decoder decoder(bytes.data(), bytes.size(), true);
  const charls::frame_info& frame = decoder.frame_info();
  // Before anything is decoded: its own header decides how much memory that takes.
  if (frame.width != static_cast<std::uint32_t>(format.columns) ||
      frame.height != static_cast<std::uint32_t>(format.rows) || frame.component_count != 1) {
    throw DicomError(say("jpeg-ls-size"));
  }
  if (frame.bits_per_sample > 8) {
    decoder.decode(values.data(), values.size_bytes());
  } else {
    std::vector<std::uint8_t> small(values.size());
    decoder.decode(small.data(), small.size());
    std::copy(small.begin(), small.end(), values.begin());
  }
}

// The stream without the zeros that some coders leave between its last pixel and its end marker; nothing if there are
// none.
std::optional<std::vector<std::byte>> without_zero_before_end(std::span<const std::byte> bytes) {
  constexpr std::byte mark{0xFF};
  constexpr std::byte end{0xD9};
  for (std::size_t at = bytes.size(); at-- > 2;) {
    if (bytes[at - 1] != mark || bytes[at] != end) continue;
    std::size_t last = at - 1;
    if (last == 0 || bytes[last - 1] != std::byte{0}) return std::nullopt;
    std::vector<std::byte> shorter(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(last - 1));
    shorter.insert(shorter.end(), bytes.begin() + static_cast<std::ptrdiff_t>(last), bytes.end());
    return shorter;
  }
  return std::nullopt;
}

}  // namespace

Text decode_jpeg_ls(const PixelFormat& format, std::span<const std::byte> bytes, std::span<std::uint16_t> values) {
  try {
    decode_whole(format, bytes, values);
    return {};
  } catch (const charls::jpegls_error& error) {
    const Text why = say("jpeg-ls-cannot-be-decoded", error.what());
    auto shorter = without_zero_before_end(bytes);
    for (int n = 0; n < 4 && shorter; ++n) {
      try {
        decode_whole(format, *shorter, values);
        return say("jpeg-ls-images-hold-zeros-before");
      } catch (const charls::jpegls_error&) {
        shorter = without_zero_before_end(*shorter);
      }
    }
    throw DicomError(why);
  }
}

}  // namespace palpate::io::internal
