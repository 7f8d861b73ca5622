#include "io/dicom/decode.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcuid.h>

#include <algorithm>
#include <array>
#include <string_view>

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

constexpr const char* deflated_frames = "1.2.840.10008.1.2.8.1";  // PS3.6 annex A; DCMTK 3.6.7 does not know it
constexpr std::uint64_t most_pixels_deflated = 1032;              // per byte: zlib's documented limit

constexpr std::array syntaxes{Syntax{UID_JPEGProcess1TransferSyntax, decode_jpeg, 256},
                              Syntax{UID_JPEGProcess2_4TransferSyntax, decode_jpeg, 256},
                              Syntax{UID_JPEGProcess6_8TransferSyntax, decode_jpeg, 256},
                              Syntax{UID_JPEGProcess10_12TransferSyntax, decode_jpeg, 256},
                              Syntax{UID_JPEGProcess14TransferSyntax, decode_jpeg, 256},
                              Syntax{UID_JPEGProcess14SV1TransferSyntax, decode_jpeg, 256},
                              Syntax{UID_JPEGLSLosslessTransferSyntax, decode_jpeg_ls, 1024},
                              Syntax{UID_JPEGLSLossyTransferSyntax, decode_jpeg_ls, 1024},
                              Syntax{UID_JPEG2000LosslessOnlyTransferSyntax, decode_jpeg2000, 1024},
                              Syntax{UID_JPEG2000TransferSyntax, decode_jpeg2000, 1024},
                              Syntax{UID_RLELosslessTransferSyntax, decode_rle, 256},
                              Syntax{deflated_frames, decode_deflated_frame, most_pixels_deflated}};

const Syntax* find_syntax(const std::string& uid) {
  const auto found = std::find_if(syntaxes.begin(), syntaxes.end(), [&](const Syntax& s) { return uid == s.uid; });
  return found != syntaxes.end() ? &*found : nullptr;
}

}  // namespace

bool can_decode(const std::string& transfer_syntax) {
  return find_syntax(transfer_syntax) != nullptr;
}

bool is_packed(const std::string& transfer_syntax) {
  return transfer_syntax == UID_RLELosslessTransferSyntax || transfer_syntax == deflated_frames;
}

std::vector<std::byte> unpack_frame(const std::string& transfer_syntax, const PixelFormat& format,
                                    std::span<const std::byte> bytes) {
  check_density(transfer_syntax, format, 1, bytes.size());
  return transfer_syntax == deflated_frames ? inflate_frame(format, bytes) : unpack_rle(format, bytes);
}

Text why_not_decoded(const std::string& transfer_syntax) {
  struct Named {  // PS3.6 annex A
    std::string_view uid;
    const char* name;
  };
  constexpr std::array names{Named{"1.2.840.10008.1.2.4.201", "HTJ2K (High-Throughput JPEG 2000)"},
                             Named{"1.2.840.10008.1.2.4.202", "HTJ2K (High-Throughput JPEG 2000)"},
                             Named{"1.2.840.10008.1.2.4.203", "HTJ2K (High-Throughput JPEG 2000)"},
                             Named{"1.2.840.10008.1.2.4.204", "HTJ2K (High-Throughput JPEG 2000, by JPIP)"},
                             Named{"1.2.840.10008.1.2.4.205", "HTJ2K (High-Throughput JPEG 2000, by JPIP)"},
                             Named{"1.2.840.10008.1.2.4.92", "JPEG 2000 of several components (part 2)"},
                             Named{"1.2.840.10008.1.2.4.93", "JPEG 2000 of several components (part 2)"},
                             Named{"1.2.840.10008.1.2.4.94", "JPIP, which leaves the pixels at a server"},
                             Named{"1.2.840.10008.1.2.4.95", "JPIP, which leaves the pixels at a server"},
                             Named{"1.2.840.10008.1.2.4.100", "MPEG-2, a video"},
                             Named{"1.2.840.10008.1.2.4.101", "MPEG-2, a video"},
                             Named{"1.2.840.10008.1.2.4.102", "MPEG-4 (H.264), a video"},
                             Named{"1.2.840.10008.1.2.4.103", "MPEG-4 (H.264), a video"},
                             Named{"1.2.840.10008.1.2.4.107", "HEVC (H.265), a video"},
                             Named{"1.2.840.10008.1.2.4.108", "HEVC (H.265), a video"},
                             Named{"1.2.840.10008.1.2.4.110", "JPEG XL"},
                             Named{"1.2.840.10008.1.2.4.111", "JPEG XL"},
                             Named{"1.2.840.10008.1.2.4.112", "JPEG XL"}};
  const auto found = std::ranges::find(names, transfer_syntax, &Named::uid);
  if (found == names.end()) return say("compression-is-unknown-here", transfer_syntax);
  return say("compression-is-not-decoded-here", found->name);
}

void check_inflation(std::uint64_t bytes_out, std::uint64_t bytes_in) {
  constexpr std::uint64_t any = std::uint64_t{1} << 28, most = std::uint64_t{1} << 33;
  constexpr std::uint64_t most_times = 50;  // scans inflate to 2 to 10 times their size
  if (bytes_out > any && (bytes_out > most || bytes_out / most_times > bytes_in)) {
    throw DicomError(say("inflates-to-too-much", bytes_in, bytes_out >> 20U));
  }
}

void check_density(const std::string& transfer_syntax, const PixelFormat& format, std::size_t frames,
                   std::uint64_t bytes) {
  const Syntax* syntax = find_syntax(transfer_syntax);
  const std::uint64_t pixels_per_byte = syntax != nullptr ? syntax->most_pixels_per_byte : most_pixels_deflated;
  constexpr std::uint64_t small = 1U << 18;  // pixels that a file of any size may have: an empty slice is small
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
