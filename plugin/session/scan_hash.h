#pragma once

/// A scan's content in 16 digits: the same for the same values at the same places, however they are stored and wherever
/// they are. It is made of its slices' hashes, so that it can be had of a scan that is never in one place: a server
/// reads it slice by slice.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/volume.h"

namespace palpate::plugin {

/// XXH3 of a slice's rescaled values, rounded to floats.
std::uint64_t hash_of_slice(const io::Volume& volume, int k);

/// Of all slices; of a velocity field then those of each of its components.
std::vector<std::uint64_t> hashes_of_slices(const io::Volume& volume);

/// 16 hexadecimal digits that tell one scan from another: of the geometry, what is padding, the directions of vectors,
/// and `slices` as from hashes_of_slices(). No voxels are read of the volume.
std::string hash_of(const io::Volume& without_voxels, std::span<const std::uint64_t> slices);
std::string hash_of(const io::Volume& volume);

}  // namespace palpate::plugin
