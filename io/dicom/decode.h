#pragma once

/// One compressed frame -> stored values. JPEG by DCMTK's IJG codecs, JPEG-LS by CharLS, JPEG 2000 by OpenJPEG, RLE by
/// ourselves, deflated frames by zlib: the decoders for JPEG-LS and RLE inside DCMTK 3.6.7 write beyond their buffers
/// on damaged streams.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/dicom/file_header.h"

namespace palpate::io::internal {

/// Whether images in this encapsulated transfer syntax can be decoded.
bool can_decode(const std::string& transfer_syntax);

/// Whether a frame in this syntax is native bytes, packed: pixels of any number of bits. Others hold up to 16.
bool is_packed(const std::string& transfer_syntax);

/// Throws DicomError where `bytes` of this syntax cannot hold that many frames of that format: no coder packs pixels
/// more densely than the bound used here, so a header that claims 60000 rows in a small file costs no memory.
void check_density(const std::string& transfer_syntax, const PixelFormat& format, std::size_t frames,
                   std::uint64_t bytes);

/// Why pixels of a syntax that can_decode() does not know are refused: by the name of the compression.
Text why_not_decoded(const std::string& transfer_syntax);

/// Throws DicomError where what was deflated would come out so large that it is a trap, or damaged: more than 256 MiB
/// and 50 times the file, or more than 8 GiB. `bytes_out` is what is claimed, `bytes_in` the file.
void check_inflation(std::uint64_t bytes_out, std::uint64_t bytes_in);

/// Decodes one frame: `values` holds rows * columns. Returns what of the stream is against its standard without costing
/// a pixel, in words for the user; empty where nothing is. Throws DicomError with a reason where the stream is damaged
/// or is an image of another size than the header says.
Text decode_frame(const std::string& transfer_syntax, const PixelFormat& format, std::span<const std::byte> bytes,
                  std::span<std::uint16_t> values);

/// The native bytes of a frame, little endian, of a syntax that is_packed(): RLE (PS3.5 annex G), or deflated (A.4.13).
/// Throws DicomError where the stream is damaged or has another size than the header says.
std::vector<std::byte> unpack_frame(const std::string& transfer_syntax, const PixelFormat& format,
                                    std::span<const std::byte> bytes);

// The decoders of each family, as decode_frame(). Samples are as the stream holds them: bits that the format does not
// store and signs are left to the caller.
Text decode_jpeg(const PixelFormat& format, std::span<const std::byte> bytes, std::span<std::uint16_t> values);
Text decode_jpeg_ls(const PixelFormat& format, std::span<const std::byte> bytes, std::span<std::uint16_t> values);
Text decode_jpeg2000(const PixelFormat& format, std::span<const std::byte> bytes, std::span<std::uint16_t> values);
Text decode_rle(const PixelFormat& format, std::span<const std::byte> bytes, std::span<std::uint16_t> values);
Text decode_deflated_frame(const PixelFormat& format, std::span<const std::byte> bytes,
                           std::span<std::uint16_t> values);

/// Native pixels of 8 or 16 bits -> stored values.
void put_little_endian(const PixelFormat& format, std::span<const std::byte> bytes, std::span<std::uint16_t> values);
std::vector<std::byte> unpack_rle(const PixelFormat& format, std::span<const std::byte> bytes);
std::vector<std::byte> inflate_frame(const PixelFormat& format, std::span<const std::byte> bytes);

/// What a JPEG stream says of itself in its SOF marker (ISO 10918-1 annex B).
struct JpegFrame {
  int columns = 0;
  int rows = 0;
  int precision = 0;
};
std::optional<JpegFrame> jpeg_frame(std::span<const std::byte> bytes);

/// Throws DicomError where a Huffman table of a JPEG stream codes differences of more than `most_bits` (ISO 10918-1
/// H.1.2.2 knows 16): DCMTK 3.6.7's decoders index tables of 16 or 17 numbers by them, unchecked.
void check_huffman_tables(std::span<const std::byte> bytes, std::size_t most_bits);

}  // namespace palpate::io::internal
