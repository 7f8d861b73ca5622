#pragma once

/// Masks of bodies that a formula gives.

#include <utility>

#include "io/structures/mask_source.h"

namespace palpate::io::testing {

/// A file of one mask.
class OneMask final : public MaskSource {
 public:
  explicit OneMask(Mask mask) : mask_(std::move(mask)) {}

 private:
  Mask mask_of(int /*number*/) const override { return mask_; }
  Mask mask_;
};

/// The voxels whose centers lie within a body; `depth(position)`: how deep it lies in it, mm.
template <typename Depth>
Mask mask_of(const Geometry& geometry, const Depth& depth) {
  Mask mask;
  mask.geometry = geometry;
  mask.size = geometry.dimensions;
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        mask.occupancy.push_back(depth(geometry.to_patient({i, j, k})) > 0 ? Mask::full : 0);
      }
    }
  }
  return mask;
}

}  // namespace palpate::io::testing
