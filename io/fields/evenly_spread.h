#pragma once

/// An evenly spread sample of many voxels. Their offsets are hashed, because an even stride would align with the rows.

#include <cstdint>
#include <limits>

namespace palpate::io::internal {

class EvenlySpread {
 public:
  /// About `enough` of `all`, or all if there are not many more.
  EvenlySpread(std::uint64_t all, std::uint64_t enough)
      : reciprocal_(std::numeric_limits<std::uint64_t>::max() / (1 + all / enough) + 1) {}

  /// Whether the hash is a multiple of the stride. Computed by two multiplications, because a division for each voxel
  /// would take most of the time. Source: Lemire, Kaser and Kurz, "Faster remainder by direct computation", Software:
  /// Practice and Experience 49(6), 2019; exact for 32 bits.
  bool has(std::uint64_t offset) const noexcept {
    const std::uint64_t hash = (offset * 0x9E3779B97F4A7C15U) >> 32U;
    return hash * reciprocal_ <= reciprocal_ - 1;
  }

 private:
  std::uint64_t reciprocal_;  // 2^64 over the stride, rounded up; 0 for a stride of 1
};

}  // namespace palpate::io::internal
