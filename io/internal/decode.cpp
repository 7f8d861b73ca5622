#include "palpate/io/internal/decode.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdatset.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <dcmtk/dcmdata/dcxfer.h>

#include <algorithm>
#include <array>
#include <memory>

#include "palpate/io/errors.h"

namespace palpate::io::internal {
namespace {

bool is_jpeg2000(const std::string& syntax) {
  return syntax == UID_JPEG2000LosslessOnlyTransferSyntax || syntax == UID_JPEG2000TransferSyntax;
}

bool is_jpeg_ls(const std::string& syntax) {
  return syntax == UID_JPEGLSLosslessTransferSyntax || syntax == UID_JPEGLSLossyTransferSyntax;
}

bool is_jpeg(const std::string& syntax) {
  constexpr std::array known{UID_JPEGProcess1TransferSyntax, UID_JPEGProcess2_4TransferSyntax,
                             UID_JPEGProcess14TransferSyntax, UID_JPEGProcess14SV1TransferSyntax};
  return std::find(known.begin(), known.end(), syntax) != known.end();
}

void check(const OFCondition& condition) {
  if (condition.bad())
    throw DicomError(std::string("damaged: its pixels cannot be decoded (") + condition.text() + ")");
}

// A dataset of this one frame, so that DCMTK's decoders need neither the file nor its other frames.
void decode_by_dcmtk(const std::string& syntax, const PixelFormat& format, std::span<const std::byte> bytes,
                     std::span<std::byte> buffer) {
  DcmDataset dataset;
  check(dataset.putAndInsertUint16(DCM_SamplesPerPixel, 1));
  check(dataset.putAndInsertString(DCM_PhotometricInterpretation, "MONOCHROME2"));
  check(dataset.putAndInsertUint16(DCM_Rows, static_cast<Uint16>(format.rows)));
  check(dataset.putAndInsertUint16(DCM_Columns, static_cast<Uint16>(format.columns)));
  check(dataset.putAndInsertUint16(DCM_BitsAllocated, static_cast<Uint16>(format.bits_allocated)));
  check(dataset.putAndInsertUint16(DCM_BitsStored, static_cast<Uint16>(format.bits_stored)));
  check(dataset.putAndInsertUint16(DCM_HighBit, static_cast<Uint16>(format.high_bit)));
  check(dataset.putAndInsertUint16(DCM_PixelRepresentation, format.is_signed ? 1 : 0));
  check(dataset.putAndInsertString(DCM_NumberOfFrames, "1"));

  auto sequence = std::make_unique<DcmPixelSequence>(DCM_PixelSequenceTag);
  check(sequence->insert(new DcmPixelItem(DCM_PixelItemTag)));  // an empty offset table
  auto item = std::make_unique<DcmPixelItem>(DCM_PixelItemTag);
  check(item->putUint8Array(reinterpret_cast<const Uint8*>(bytes.data()), static_cast<unsigned long>(bytes.size())));
  check(sequence->insert(item.release()));
  auto pixels = std::make_unique<DcmPixelData>(DCM_PixelData);
  pixels->putOriginalRepresentation(DcmXfer(syntax.c_str()).getXfer(), nullptr, sequence.release());
  DcmPixelData& data = *pixels;
  check(dataset.insert(pixels.release()));

  Uint32 fragment = 1;  // behind the offset table
  OFString colour_model;
  check(data.getUncompressedFrame(&dataset, 0, fragment, buffer.data(), static_cast<Uint32>(buffer.size()),
                                  colour_model));
}

}  // namespace

bool can_decode(const std::string& syntax) {
  return is_jpeg(syntax) || is_jpeg_ls(syntax) || is_jpeg2000(syntax) || syntax == UID_RLELosslessTransferSyntax;
}

void check_density(const std::string& syntax, const PixelFormat& format, std::size_t frames, std::uint64_t bytes) {
  // RLE packs 128 bytes in 2; deflate 1032 in 1. JPEG's Huffman codes need a bit a pixel, or a few a block of 64 with
  // the discrete cosine transform. The run mode of JPEG-LS and the empty packets of JPEG 2000 have no such bound, but
  // hundreds of pixels a byte are an empty image.
  const std::uint64_t pixels_per_byte = is_jpeg(syntax) || syntax == UID_RLELosslessTransferSyntax ? 256 : 1024;
  constexpr std::uint64_t small = 1U << 18;  // pixels that any file may claim: an empty slice
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(format.columns) * static_cast<std::uint64_t>(format.rows) * frames;
  if (pixels > small && pixels / pixels_per_byte > bytes) {
    throw DicomError("damaged: " + std::to_string(bytes) + " bytes cannot hold " + std::to_string(pixels) + " pixels");
  }
}

std::optional<std::pair<int, int>> jpeg_size(std::span<const std::byte> bytes) {
  const auto byte = [&](std::size_t i) { return std::to_integer<int>(bytes[i]); };
  std::size_t at = 2;
  while (at + 9 <= bytes.size()) {
    if (byte(at) != 0xFF) return std::nullopt;
    const int marker = byte(at + 1);
    if (marker == 0xFF) {  // a fill byte
      ++at;
      continue;
    }
    const bool frame =
        marker == 0xF7 || (marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC);
    if (frame) return std::pair(byte(at + 7) << 8 | byte(at + 8), byte(at + 5) << 8 | byte(at + 6));
    at += 2 + static_cast<std::size_t>(byte(at + 2) << 8 | byte(at + 3));
  }
  return std::nullopt;
}

void decode_frame(const std::string& syntax, const PixelFormat& format, std::span<const std::byte> bytes,
                  std::span<std::uint16_t> values) {
  check_density(syntax, format, 1, bytes.size());
  if (is_jpeg2000(syntax)) {
    decode_jpeg2000(format, bytes, values);
    return;
  }
  if (syntax != UID_RLELosslessTransferSyntax) {
    const auto size = jpeg_size(bytes);
    if (!size) throw DicomError("damaged: no JPEG image in its compressed pixels");
    if (*size != std::pair(format.columns, format.rows)) {
      throw DicomError("damaged: its compressed image is " + std::to_string(size->first) + " x " +
                       std::to_string(size->second) + ", not " + std::to_string(format.columns) + " x " +
                       std::to_string(format.rows));
    }
  }
  if (format.bits_allocated == 16) {
    decode_by_dcmtk(syntax, format, bytes, std::as_writable_bytes(values));
  } else {
    std::vector<std::uint8_t> small(format.bytes_per_frame() + format.bytes_per_frame() % 2);
    decode_by_dcmtk(syntax, format, bytes, std::as_writable_bytes(std::span(small)));
    std::copy_n(small.begin(), values.size(), values.begin());
  }
}

}  // namespace palpate::io::internal
