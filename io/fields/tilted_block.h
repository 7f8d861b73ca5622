#pragma once

#include <vector>

#include "io/fields/straight_block.h"

namespace palpate::io::internal {

/// straight_block() for a scan whose slices are displaced within their planes.
template <typename Stored>
void tilted_block(const Volume& volume, const std::vector<Stored>& voxels, const SliceKernel& kernel, const Fits& fits,
                  const Block& block, const GradientTarget& target);

}  // namespace palpate::io::internal
