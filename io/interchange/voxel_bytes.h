#pragma once

#include <functional>
#include <memory>
#include <span>

#include "io/interchange/voxel_file.h"

namespace palpate::io {

/// The bytes of a file's voxels, from the first one on. They are unpacked while they are read.
class VoxelBytes {
 public:
  VoxelBytes() = default;
  VoxelBytes(const VoxelBytes&) = delete;
  VoxelBytes& operator=(const VoxelBytes&) = delete;
  virtual ~VoxelBytes() = default;
  /// Fills all of `into`. Throws DicomError if the bytes end too early.
  virtual void read(std::span<std::uint8_t> into) = 0;
  virtual void skip(std::uint64_t count);
  /// Must be called after the last byte. Throws DicomError if the checksum of the unpacked bytes is not the
  /// file's.
  virtual void finish() {}
};

/// Throws DicomError if the file cannot be opened.
std::unique_ptr<VoxelBytes> voxel_bytes(const VoxelFile& file);

/// Calls `slice` for the slices `begin` to `end` - 1 of a volume (counted from 0). They lie along the file's third
/// axis. `n` is the slice's number in the file; `raw` are its numbers, in this machine's byte order. Ends early if
/// `slice` returns false. Throws DicomError if the file ends before the last voxel, or, after a whole volume, if the
/// checksum is wrong.
void read_raw_slices(const VoxelFile& file, int volume, int begin, int end,
                     const std::function<bool(int n, std::span<const std::uint8_t> raw)>& slice);

/// Passes on all slices of the first volume as values; the layers of a voxel lie side by side. `k`: the slice in the
/// geometry. Only for files whose axes are in the geometry's order.
void read_slices(const VoxelFile& file, const std::function<bool(int k, std::span<const double> values)>& slice);

/// The number at `from`, in this machine's byte order.
double number_at(VoxelFile::Number number, const std::uint8_t* from) noexcept;

}  // namespace palpate::io
