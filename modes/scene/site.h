#pragma once

/// Where the edges of a CT lie.

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate::modes {

/// Skin is where air of the room meets the body; lung and inner_air, where air within the body does; cloth, and foam,
/// where air meets what is lighter than -400 HU; elsewhere, where no air is near.
enum class Site : std::uint8_t { skin, lung, inner_air, table, cloth, elsewhere };
inline constexpr std::size_t sites = 6;
/// How many edges lie at each place.
using SiteCounts = std::array<std::uint64_t, sites>;

}  // namespace palpate::modes
