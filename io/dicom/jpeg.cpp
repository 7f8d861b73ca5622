#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmjpeg/djcparam.h>
#include <dcmtk/dcmjpeg/djdijg12.h>
#include <dcmtk/dcmjpeg/djdijg16.h>
#include <dcmtk/dcmjpeg/djdijg8.h>

#include <algorithm>
#include <array>
#include <vector>

#include "io/dicom/decode.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

// If data are damaged, IJG's decoders fill with gray and only print a warning. Here damage is an error.
template <typename Decompressor>
class StrictDecompressor final : public Decompressor {
 public:
  using Decompressor::Decompressor;
  void emitMessage(int level) const override {  // NOLINT(readability-identifier-naming): DCMTK's name
    damaged_ |= level == -1;
  }
  bool damaged() const { return damaged_; }

 private:
  mutable bool damaged_ = false;
};

// A sequential scan codes all 64 frequencies (ISO 10918-1 B.2.3: Ss = 0, Se = 63, Ah = Al = 0), whatever its header
// says: decoders only warn, but here a warning is an error. Returns whether a header was corrected.
bool mend_scan_headers(std::vector<Uint8>& bytes) {
  bool mended = false;
  bool sequential = false;
  std::size_t at = 2;
  while (at + 4 <= bytes.size()) {
    const int marker = bytes[at + 1];
    if (bytes[at] != 0xFF || marker == 0 || marker == 0xFF || (marker >= 0xD0 && marker <= 0xD8)) {
      ++at;
      continue;
    }
    const std::size_t end = at + 2 + (std::size_t{bytes[at + 2]} << 8 | bytes[at + 3]);
    if (marker == 0xC0 || marker == 0xC1) sequential = true;
    if (marker == 0xDA && sequential && end <= bytes.size() && end >= at + 8) {
      const std::array<Uint8, 3> whole{0, 63, 0};
      const auto said = bytes.begin() + static_cast<std::ptrdiff_t>(end - whole.size());
      mended |= !std::equal(whole.begin(), whole.end(), said);
      std::copy(whole.begin(), whole.end(), said);
    }
    at = std::max(end, at + 2);
  }
  return mended;
}

template <typename Decompressor>
Text decompress(std::span<const std::byte> bytes, std::span<std::byte> samples) {
  const DJCodecParameter parameters(ECC_lossyYCbCr, EDC_never, EUC_never, EPC_default);
  StrictDecompressor<Decompressor> decompressor(parameters, OFFalse);
  std::vector<Uint8> input(bytes.size() + bytes.size() % 2);  // the decoder needs writable input
  std::transform(bytes.begin(), bytes.end(), input.begin(), [](std::byte b) { return std::to_integer<Uint8>(b); });
  const bool mended = mend_scan_headers(input);
  OFCondition result = decompressor.init();
  if (result.good()) {
    result =
        decompressor.decode(input.data(), static_cast<Uint32>(input.size()), reinterpret_cast<Uint8*>(samples.data()),
                            static_cast<Uint32>(samples.size()), OFFalse);
  }
  if (result.bad()) throw DicomError(say("jpeg-cannot-be-decoded", result.text()));
  if (decompressor.damaged()) throw DicomError(say("jpeg-holds-errors"));
  return mended ? say("jpeg-images-name-a-range") : Text();
}

}  // namespace

std::optional<JpegFrame> jpeg_frame(std::span<const std::byte> bytes) {
  const auto byte = [&](std::size_t i) { return std::to_integer<int>(bytes[i]); };
  const auto word = [&](std::size_t i) { return byte(i) << 8 | byte(i + 1); };
  std::size_t at = 2;
  while (at + 9 <= bytes.size()) {
    if (byte(at) != 0xFF) return std::nullopt;
    const int marker = byte(at + 1);
    if (marker == 0xFF) {  // a fill byte
      ++at;
      continue;
    }
    const bool tables = marker == 0xC4 || marker == 0xC8 || marker == 0xCC;
    if (marker >= 0xC0 && marker <= 0xCF && !tables) return JpegFrame{word(at + 7), word(at + 5), byte(at + 4)};
    at += 2 + static_cast<std::size_t>(word(at + 2));
  }
  return std::nullopt;
}

void check_huffman_tables(std::span<const std::byte> bytes, std::size_t most_bits) {
  const auto byte = [&](std::size_t i) { return std::to_integer<std::size_t>(bytes[i]); };
  constexpr std::size_t counts = 16;  // bytes with the number of codes of each length, 1 to 16 bits
  std::size_t at = 2;
  while (at + 4 <= bytes.size()) {
    const std::size_t marker = byte(at + 1);
    // Coded pixels, between segments, hold FF only before 0 or as a restart; fill bytes may precede a marker.
    if (byte(at) != 0xFF || marker == 0 || marker == 0xFF || (marker >= 0xD0 && marker <= 0xD8)) {
      ++at;
      continue;
    }
    const std::size_t end = at + 2 + (byte(at + 2) << 8 | byte(at + 3));
    if (marker == 0xC4) {
      for (std::size_t table = at + 4; table + 1 + counts <= std::min(end, bytes.size());) {
        std::size_t symbols = 0;
        for (std::size_t n = 1; n <= counts; ++n) symbols += byte(table + n);
        const std::size_t last = std::min(table + 1 + counts + symbols, bytes.size());
        const bool differences = byte(table) >> 4 == 0;
        for (std::size_t symbol = table + 1 + counts; differences && symbol < last; ++symbol) {
          if (byte(symbol) > most_bits) throw DicomError(say("jpeg-huffman-table"));
        }
        table = last;
      }
    }
    at = std::max(end, at + 2);
  }
}

Text decode_jpeg(const PixelFormat& format, std::span<const std::byte> bytes, std::span<std::uint16_t> values) {
  const auto frame = jpeg_frame(bytes);
  if (!frame) throw DicomError(say("no-jpeg-image"));
  // Before anything is decoded: these numbers decide how much memory that takes.
  if (frame->columns != format.columns || frame->rows != format.rows) {
    throw DicomError(say("jpeg-size", frame->columns, frame->rows, format.columns, format.rows));
  }
  check_huffman_tables(bytes, frame->precision > 12 ? 16 : 15);  // the 16-bit decoder's table is longer by one
  if (frame->precision > 12) {
    return decompress<DJDecompressIJG16Bit>(bytes, std::as_writable_bytes(values));
  }
  if (frame->precision > 8) return decompress<DJDecompressIJG12Bit>(bytes, std::as_writable_bytes(values));
  std::vector<std::uint8_t> small(values.size());
  Text note = decompress<DJDecompressIJG8Bit>(bytes, std::as_writable_bytes(std::span(small)));
  std::copy(small.begin(), small.end(), values.begin());
  return note;
}

}  // namespace palpate::io::internal
