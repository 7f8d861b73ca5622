#pragma once

/// Reads voxels that are neither raw nor deflated.

#include <memory>

#include "io/interchange/voxel_bytes.h"

namespace palpate::io {

/// Packed by bzip2. Throws DicomError if the file cannot be opened.
std::unique_ptr<VoxelBytes> bunzipped(const VoxelFile& file);

/// Packing::ascii: numbers between spaces, line ends or commas, given in this machine's byte order. Packing::hex: two
/// digits a byte, with anything between them that is not a digit. Throws DicomError if the file cannot be opened.
/// Reading throws if a word is not a number of the file's type.
std::unique_ptr<VoxelBytes> voxels_in_words(const VoxelFile& file);

}  // namespace palpate::io
