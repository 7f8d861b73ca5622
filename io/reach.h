#pragma once

/// Limits of the positions and spacings that a scan of a patient can have. A header beyond them is damaged.

namespace palpate::io::internal {

constexpr double farthest_place_mm = 1e5;  ///< from the origin: 100 m
constexpr double least_spacing_mm = 1e-5;  ///< between voxels: 10 nm

}  // namespace palpate::io::internal
