#pragma once

/// The frames of a DICOM segmentation, each decoded when it is used.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/dicom/dataset.h"
#include "io/dicom/file_header.h"
#include "io/structures/mask.h"

namespace palpate::io {

enum class SegmentationType : std::uint8_t { binary, probability, occupancy, label_map };

struct SegmentationPixels {
  std::filesystem::path path;
  internal::DatasetStart start;
  internal::PixelFormat format;  ///< bits_allocated 1, 8 or 16
  internal::PixelCoding coding = internal::PixelCoding::native;
  bool big_endian = false;
  bool swapped_words = false;  ///< bytes lie in 16-bit words of the other byte order
  std::uint64_t at = 0;        ///< first byte of the pixels, in the file or in the inflated dataset
  std::vector<std::vector<internal::Fragment>> fragments;
};

/// Finds the pixels. Throws DicomError if they cannot be there or cannot be decoded.
SegmentationPixels find_pixels(const std::filesystem::path& path, const internal::DatasetStart& start,
                               const internal::PixelElement& pixels, const internal::PixelFormat& format,
                               std::size_t frames);

/// Reads frames. A deflated file is inflated once if they are read in order. For one thread.
class FrameReader {
 public:
  /// The pixels must outlive it.
  explicit FrameReader(const SegmentationPixels& pixels) : pixels_(pixels), file_(pixels.path) {}

  /// A frame's stored values, columns * rows of them. Throws DicomError.
  void read(std::uint32_t frame, std::span<std::uint16_t> values);
  /// How many bytes had to be inflated for all that was read.
  std::uint64_t inflated_bytes() const noexcept { return inflated_bytes_; }

 private:
  std::vector<std::byte> read_bytes(std::uint64_t offset, std::uint64_t count);
  void inflate(std::uint64_t at, std::span<std::byte> bytes);
  void read_bits(std::uint32_t frame, std::span<std::uint16_t> values);
  void read_words(std::uint32_t frame, std::span<std::uint16_t> values);
  void read_encapsulated(std::uint32_t frame, std::span<std::uint16_t> values);

  const SegmentationPixels& pixels_;
  internal::InputFile file_;
  std::unique_ptr<internal::ByteSource> inflated_;
  std::uint64_t inflated_to_ = 0;
  std::byte last_{0};  ///< the last one inflated: frames of bits may share it
  std::uint64_t inflated_bytes_ = 0;
};

}  // namespace palpate::io
