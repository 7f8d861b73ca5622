#pragma once

#include <array>
#include <limits>

namespace palpate::modes {

/// The most likely tissue for a value of a CT, by its HU alone.
inline const char* ct_tissue(double hu) noexcept {
  struct Range {
    double below;
    const char* name;
  };
  constexpr std::array ranges{Range{-900, "air"}, Range{-200, "lung or foam"}, Range{-25, "fat"},
                              Range{150, "soft tissue"}, Range{2500, "bone"}};
  for (const Range& range : ranges) {
    if (hu < range.below) return range.name;
  }
  return "metal";
}

}  // namespace palpate::modes
