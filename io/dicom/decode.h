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

/// Whether a frame in this syntax is packed native bytes, with any number of bits a pixel. Other syntaxes have up
/// to 16.
bool is_packed(const std::string& transfer_syntax);

/// Throws DicomError if `bytes` bytes of this syntax are too few for so many frames of that format. No coder packs
/// pixels more densely than the bound that is used here, so a small file that claims 60000 rows costs no memory.
void check_density(const std::string& transfer_syntax, const PixelFormat& format, std::size_t frames,
                   std::uint64_t bytes);

/// Why pixels are refused if can_decode() does not know their syntax. Names the compression.
Text why_not_decoded(const std::string& transfer_syntax);

/// Throws DicomError if deflated data would become so large that the file is an attack or damaged: more than 256 MiB
/// and 50 times the file, or more than 8 GiB. `bytes_out`: the claimed size. `bytes_in`: the file's size.
void check_inflation(std::uint64_t bytes_out, std::uint64_t bytes_in);

/// Decodes one frame: `values` holds rows * columns. Returns, in words for the user, how the stream departs
/// from its standard where that costs no pixel; empty if it does not. Throws DicomError with a reason if the stream is
/// damaged or has another size than the header says.
Text decode_frame(const std::string& transfer_syntax, const PixelFormat& format, std::span<const std::byte> bytes,
                  std::span<std::uint16_t> values);

/// The native bytes of a frame, little endian, of a syntax that is_packed(): RLE (PS3.5 annex G), or deflated (A.4.13).
/// Throws DicomError if the stream is damaged or has another size than the header says.
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

/// The contents of a JPEG stream's SOF marker (ISO 10918-1 annex B).
struct JpegFrame {
  int columns = 0;
  int rows = 0;
  int precision = 0;
};
std::optional<JpegFrame> jpeg_frame(std::span<const std::byte> bytes);

/// Throws DicomError if a Huffman table of a JPEG stream codes differences of more than `most_bits` (ISO 10918-1
/// H.1.2.2 knows 16): DCMTK 3.6.7's decoders index tables of 16 or 17 numbers by them, unchecked.
void check_huffman_tables(std::span<const std::byte> bytes, std::size_t most_bits);

}  // namespace palpate::io::internal
