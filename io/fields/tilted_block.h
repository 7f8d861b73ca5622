#pragma once

#include <vector>

#include "io/fields/straight_block.h"

namespace palpate::io::internal {

/// The gradients of a block of a scan whose slices are displaced within their planes: as straight_block() for others.
template <typename Stored>
void tilted_block(const Volume& volume, const std::vector<Stored>& voxels, const SliceKernel& kernel, const Fits& fits,
                  const Block& block, const GradientTarget& target);

}  // namespace palpate::io::internal
