#include "io/dicom/decode.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcuid.h>

#include <algorithm>
#include <array>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

using Decoder = Text (*)(const PixelFormat&, std::span<const std::byte>, std::span<std::uint16_t>);

struct Syntax {
  const char* uid;
  Decoder decoder;
  /// RLE packs 128 bytes in 2; JPEG's Huffman codes need a bit a pixel, or a few a block of 64 with the discrete cosine
  /// transform. The run mode of JPEG-LS and the empty packets of JPEG 2000 have no such bound, but more than a thousand
  /// pixels a byte are an empty image.
  std::uint64_t most_pixels_per_byte;
};

constexpr std::array syntaxes{Syntax{UID_JPEGProcess1TransferSyntax, decode_jpeg, 256},
                              Syntax{UID_JPEGProcess2_4TransferSyntax, decode_jpeg, 256},
                              Syntax{UID_JPEGProcess14TransferSyntax, decode_jpeg, 256},
                              Syntax{UID_JPEGProcess14SV1TransferSyntax, decode_jpeg, 256},
                              Syntax{UID_JPEGLSLosslessTransferSyntax, decode_jpeg_ls, 1024},
                              Syntax{UID_JPEGLSLossyTransferSyntax, decode_jpeg_ls, 1024},
                              Syntax{UID_JPEG2000LosslessOnlyTransferSyntax, decode_jpeg2000, 1024},
                              Syntax{UID_JPEG2000TransferSyntax, decode_jpeg2000, 1024},
                              Syntax{UID_RLELosslessTransferSyntax, decode_rle, 256}};
constexpr std::uint64_t most_pixels_deflated = 1032;  // a byte, zlib's documented limit

const Syntax* find_syntax(const std::string& uid) {
  const auto found = std::find_if(syntaxes.begin(), syntaxes.end(), [&](const Syntax& s) { return uid == s.uid; });
  return found != syntaxes.end() ? &*found : nullptr;
}

}  // namespace

bool can_decode(const std::string& transfer_syntax) {
  return find_syntax(transfer_syntax) != nullptr;
}

void check_density(const std::string& transfer_syntax, const PixelFormat& format, std::size_t frames,
                   std::uint64_t bytes) {
  const Syntax* syntax = find_syntax(transfer_syntax);
  const std::uint64_t pixels_per_byte = syntax != nullptr ? syntax->most_pixels_per_byte : most_pixels_deflated;
  constexpr std::uint64_t small = 1U << 18;  // pixels that any file may claim: an empty slice
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(format.columns) * static_cast<std::uint64_t>(format.rows) * frames;
  if (pixels > small && pixels / pixels_per_byte > bytes) {
    throw DicomError(say("damaged-bytes-cannot-hold-pixels", bytes, pixels));
  }
}

Text decode_frame(const std::string& transfer_syntax, const PixelFormat& format, std::span<const std::byte> bytes,
                  std::span<std::uint16_t> values) {
  const Syntax* syntax = find_syntax(transfer_syntax);
  if (syntax == nullptr) throw DicomError(say("compression-is-unknown-here", transfer_syntax));
  check_density(transfer_syntax, format, 1, bytes.size());
  return syntax->decoder(format, bytes, values);
}

}  // namespace palpate::io::internal
