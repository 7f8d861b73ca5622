#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "io/dicom/file_header.h"

namespace palpate::io {

struct VoxelFile;

struct SeriesSource {
  struct Slice {
    std::uint32_t file = 0;   ///< index into files
    std::uint32_t plane = 0;  ///< index into that file's planes
  };
  /// One volume of the series: a time point, an echo, a b-value.
  struct Frame {
    std::vector<Slice> slices;  ///< ascending along direction_i x direction_j
    std::vector<Vec3> lost;     ///< positions (mm) of slices that are known to exist but cannot be read
  };

  std::shared_ptr<const std::vector<internal::FileHeader>> files;  ///< shared by all series of one UID
  std::vector<Frame> frames;
  std::shared_ptr<const VoxelFile> voxel_file;  ///< of a scan that is not DICOM, which has no files and frames
  std::shared_ptr<const void> keeper;  ///< keeps the unpacked voxel file in existence; null if it was not packed

  /// One component of a velocity: a frame of the series with that component.
  struct Component {
    std::shared_ptr<const SeriesSource> source;
    std::size_t frame = 0;
  };
  /// By time, for a velocity with three components; such a series has no files and frames of its own.
  std::vector<std::array<Component, 3>> velocities;

  const internal::FileHeader& file_of(const Slice& slice) const { return (*files)[slice.file]; }
  const internal::Plane& plane_of(const Slice& slice) const { return file_of(slice).planes[slice.plane]; }
};

}  // namespace palpate::io
