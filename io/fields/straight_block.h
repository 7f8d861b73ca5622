#pragma once

#include <cstddef>
#include <vector>

#include "io/fields/fits.h"
#include "io/fields/slice_kernel.h"
#include "io/volume.h"

namespace palpate::io::internal {

/// Where a block's gradients are written: the first voxel's, and the strides of rows and slices, in gradients.
struct GradientTarget {
  glm::vec3* first = nullptr;
  std::ptrdiff_t row = 0;
  std::ptrdiff_t slice = 0;
};

/// The gradients of a block of a scan with straight slices, slice by slice; voxels beside padding by fits of their own.
/// Allocates a few hundred KiB, and some MiB where there is padding. Instantiated for the types that volumes store.
template <typename Stored>
void straight_block(const Volume& volume, const std::vector<Stored>& voxels, const SliceKernel& kernel,
                    const Fits& fits, const Block& block, const GradientTarget& target);

}  // namespace palpate::io::internal
