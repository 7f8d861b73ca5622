#pragma once

/// Which stored values of a volume are padding. Whole rows are tested at once.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "io/volume.h"

namespace palpate::io::internal {

/// 1 for infinity and NaN, else 0.
inline std::uint32_t is_infinite(float value) noexcept {
  constexpr std::uint32_t exponent = 0x7f800000;  // all bits set
  return static_cast<std::uint32_t>((std::bit_cast<std::uint32_t>(value) & exponent) == exponent);
}

/// Stored values from `low` to `high`, both ends included, and floats that are not finite.
template <typename Stored>
class StoredPadding {
 public:
  explicit StoredPadding(const Volume& volume) {
    using Limits = std::numeric_limits<Stored>;
    if (!volume.padding || !(volume.padding->first <= volume.padding->second)) return;
    const auto [first, second] = *volume.padding;
    if (second < static_cast<double>(Limits::lowest()) || first > static_cast<double>(Limits::max())) return;
    low_ = static_cast<Stored>(std::max(first, static_cast<double>(Limits::lowest())));
    high_ = static_cast<Stored>(std::min(second, static_cast<double>(Limits::max())));
    // A bound that was rounded outwards is not padding itself.
    if (static_cast<double>(low_) < first) low_ = next(low_, Limits::max());
    if (static_cast<double>(high_) > second) high_ = next(high_, Limits::lowest());
  }

  /// Whether a voxel may be padding.
  bool possible() const noexcept { return std::is_floating_point_v<Stored> || low_ <= high_; }
  /// Whether there is a range of padding values, in addition to infinity and NaN.
  bool has_range() const noexcept { return low_ <= high_; }
  Stored low() const noexcept { return low_; }
  Stored high() const noexcept { return high_; }
  /// 1 for padding, 0 for a value. Without branches, so that the compiler can vectorize it.
  std::uint32_t operator()(Stored stored) const noexcept {
    const std::uint32_t within =
        static_cast<std::uint32_t>(stored >= low_) & static_cast<std::uint32_t>(stored <= high_);
    if constexpr (std::is_floating_point_v<Stored>) {
      return within | is_infinite(stored);
    } else {
      return within;
    }
  }

 private:
  static Stored next(Stored from, Stored towards) {
    if constexpr (std::is_floating_point_v<Stored>) {
      return std::nextafter(from, towards);
    } else {
      return static_cast<Stored>(from < towards ? from + 1 : from - 1);
    }
  }

  Stored low_ = std::numeric_limits<Stored>::max();
  Stored high_ = std::numeric_limits<Stored>::lowest();
};

}  // namespace palpate::io::internal
