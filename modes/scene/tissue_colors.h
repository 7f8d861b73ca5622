#pragma once

/// The color of a boundary by its tissue: the same in the starting scenes and in proposed ones.
///
/// Okabe and Ito's colors: told apart by the color-blind too. Source: "Color universal design", 2008.

#include <array>
#include <cstddef>
#include <string_view>

namespace palpate::modes {

enum class TissueKind { skin, bone, soft_tissue, lung, inner_air, metal, vessel, table };

inline constexpr std::array tissue_colors{"#e69f00", "#0072b2", "#009e73", "#56b4e9",
                                          "#cc79a7", "#f0e442", "#d55e00", "#999999"};

constexpr const char* color_of(TissueKind kind) noexcept {
  return tissue_colors[static_cast<std::size_t>(kind)];
}

/// The kind of a boundary by its name; for several tissues, such as "Skin, lung surface and table", that of the first.
/// Soft tissue if the name has none of these.
TissueKind kind_of(std::string_view boundary_name);

}  // namespace palpate::modes
