#pragma once

/// The places of edges in a CT.

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate::modes {

/// skin: air of the room meets the body; lung and inner_air: air within the body meets it; cloth (also foam): air meets
/// material lighter than -400 HU; elsewhere: no air is near.
enum class Site : std::uint8_t { skin, lung, inner_air, table, cloth, elsewhere };
inline constexpr std::size_t sites = 6;
/// The number of edges at each place.
using SiteCounts = std::array<std::uint64_t, sites>;

}  // namespace palpate::modes
