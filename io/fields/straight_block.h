#pragma once

#include <cstddef>
#include <vector>

#include "io/fields/fits.h"
#include "io/fields/slice_kernel.h"
#include "io/volume.h"

namespace palpate::io::internal {

/// The output of a block's gradients: the address of its first voxel's, and the distances between rows and slices, in
/// gradients.
struct GradientTarget {
  glm::vec3* first = nullptr;
  std::ptrdiff_t row = 0;
  std::ptrdiff_t slice = 0;
};

/// The gradients of a block of a scan with straight slices, slice by slice; voxels beside padding get fits of their
/// own. Allocates a few hundred KiB, and some MiB if there is padding. Instantiated for the voxel types of volumes.
template <typename Stored>
void straight_block(const Volume& volume, const std::vector<Stored>& voxels, const SliceKernel& kernel,
                    const Fits& fits, const Block& block, const GradientTarget& target);

}  // namespace palpate::io::internal
