#pragma once

/// A hash of a scan's content, 16 digits: equal for equal values at equal places, no matter how or where they are
/// stored. It is computed from the hashes of the slices. So a server can compute it slice by slice, without ever
/// holding the whole scan.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/volume.h"

namespace palpate::plugin {

/// XXH3 of a slice's rescaled values, rounded to floats.
std::uint64_t hash_of_slice(const io::Volume& volume, int k);

/// The hashes of all slices, and for a velocity field then those of each component.
std::vector<std::uint64_t> hashes_of_slices(const io::Volume& volume);

/// 16 hexadecimal digits that tell one scan from another. They depend on the geometry, the padding values, the
/// directions of vectors, and `slices` as from hashes_of_slices(). Reads no voxels of the volume.
std::string hash_of(const io::Volume& without_voxels, std::span<const std::uint64_t> slices);
std::string hash_of(const io::Volume& volume);
/// 16 hexadecimal digits that tell one series, with all of its frames, from another. They depend on its place, and on
/// its UID, which cannot be recovered from them. Reads no voxels.
std::string hash_of_series(const std::string& uid, const io::Volume& volume);

}  // namespace palpate::plugin
