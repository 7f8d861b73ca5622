#pragma once

/// Voxels behind a header that are neither raw nor deflated.

#include <memory>

#include "io/interchange/voxel_bytes.h"

namespace palpate::io {

/// Packed by bzip2. Throws DicomError where it cannot be opened.
std::unique_ptr<VoxelBytes> bunzipped(const VoxelFile& file);

/// Packing::ascii: numbers between spaces, line ends or commas, given in this machine's byte order. Packing::hex: two
/// digits a byte, with anything between that is no digit. Throws DicomError where it cannot be opened; reading does
/// where a word is no number of the file's type.
std::unique_ptr<VoxelBytes> voxels_in_words(const VoxelFile& file);

}  // namespace palpate::io
