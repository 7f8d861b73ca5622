#pragma once

/// The frames of a DICOM segmentation, each decoded when it is used.

#include <cstdint>
#include <filesystem>
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
  std::uint64_t at = 0;  ///< first byte of the pixels, in the file or in the inflated dataset
  std::vector<std::vector<internal::Fragment>> fragments;
};

/// Finds the pixels. Throws DicomError if they cannot be there or cannot be decoded.
SegmentationPixels find_pixels(const std::filesystem::path& path, const internal::DatasetStart& start,
                               const internal::PixelElement& pixels, const internal::PixelFormat& format,
                               std::size_t frames);

/// A frame's stored values, columns * rows of them. Throws DicomError.
void read_frame(const SegmentationPixels& pixels, std::uint32_t frame, std::span<std::uint16_t> values);

}  // namespace palpate::io
