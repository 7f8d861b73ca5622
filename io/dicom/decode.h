#pragma once

/// Decodes compressed frames to stored values: JPEG with DCMTK's IJG codecs, JPEG-LS with CharLS, JPEG 2000 with
/// OpenJPEG, deflated frames with zlib, RLE with our own decoder. DCMTK 3.6.7's decoders for JPEG-LS and RLE write
/// beyond their buffers on damaged streams.

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

/// Whether a frame in this syntax is packed native bytes, with pixels of any number of bits. Pixels of other syntaxes
/// have up to 16 bits.
bool is_packed(const std::string& transfer_syntax);

/// Throws DicomError if `bytes` of this syntax cannot hold that number of frames in that format. No coder packs pixels
/// more densely than the bound used here; so a small file whose header claims 60000 rows takes no memory.
void check_density(const std::string& transfer_syntax, const PixelFormat& format, std::size_t frames,
                   std::uint64_t bytes);

/// The reason why pixels with a syntax that can_decode() does not accept are refused; it names the compression.
Text why_not_decoded(const std::string& transfer_syntax);

/// Throws DicomError if deflated data would inflate to an implausible size: more than 256 MiB and 50 times the file, or
/// more than 8 GiB. `bytes_out` is the claimed size, `bytes_in` the file's.
void check_inflation(std::uint64_t bytes_out, std::uint64_t bytes_in);

/// Decodes one frame: `values` holds rows * columns. If the stream breaks the standard but its pixels can be read,
/// returns a text that tells the user so; otherwise an empty one. Throws DicomError with the reason if the stream is
/// damaged or the image's size is not that of the header.
Text decode_frame(const std::string& transfer_syntax, const PixelFormat& format, std::span<const std::byte> bytes,
                  std::span<std::uint16_t> values);

/// The native bytes of a frame, little endian, in a syntax that is_packed(): RLE (PS3.5 annex G) or deflated (A.4.13).
/// Throws DicomError if the stream is damaged or its size is not that of the header.
std::vector<std::byte> unpack_frame(const std::string& transfer_syntax, const PixelFormat& format,
                                    std::span<const std::byte> bytes);

// The decoders of each family, as decode_frame(). Samples are as in the stream: the caller handles signs and removes
// bits that are not stored.
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

/// The format in the SOF marker of a JPEG stream (ISO 10918-1 annex B).
struct JpegFrame {
  int columns = 0;
  int rows = 0;
  int precision = 0;
};
std::optional<JpegFrame> jpeg_frame(std::span<const std::byte> bytes);

/// Throws DicomError if a Huffman table of a JPEG stream codes differences of more than `most_bits` (ISO 10918-1
/// H.1.2.2 allows 16): DCMTK 3.6.7's decoders index tables of 16 or 17 numbers by them, unchecked.
void check_huffman_tables(std::span<const std::byte> bytes, std::size_t most_bits);

}  // namespace palpate::io::internal
