#pragma once

#include <functional>
#include <memory>
#include <span>

#include "io/interchange/voxel_file.h"

namespace palpate::io {

/// The bytes of a file's voxels from the first one on, unpacked as they are read.
class VoxelBytes {
 public:
  VoxelBytes() = default;
  VoxelBytes(const VoxelBytes&) = delete;
  VoxelBytes& operator=(const VoxelBytes&) = delete;
  virtual ~VoxelBytes() = default;
  /// Fills all of `into`; throws DicomError where they end before that.
  virtual void read(std::span<std::uint8_t> into) = 0;
  virtual void skip(std::uint64_t count) = 0;
};

/// Throws DicomError where the file cannot be opened.
std::unique_ptr<VoxelBytes> voxel_bytes(const VoxelFile& file);

/// Slice by slice along the file's third axis: `n` is its number in the file, `raw` its numbers in this machine's
/// order. Those of `volume` (from 0), from `begin` up to `end`. Ends early where `slice` gives false. Throws DicomError
/// where the file ends before its voxels do.
void read_raw_slices(const VoxelFile& file, int volume, int begin, int end,
                     const std::function<bool(int n, std::span<const std::uint8_t> raw)>& slice);

/// All slices of the first volume as values, those of a voxel's layers side by side. `k` is the geometry's slice: only
/// for files whose axes are the geometry's.
void read_slices(const VoxelFile& file, const std::function<bool(int k, std::span<const double> values)>& slice);

/// The number that stands at `from`, in this machine's order.
double number_at(VoxelFile::Number number, const std::uint8_t* from) noexcept;

}  // namespace palpate::io
