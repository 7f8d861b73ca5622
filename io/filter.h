#pragma once

/// A filter of a scan's values against noise, which a stylus feels as roughness. It is a setting of the scene;
/// fields/filtered.h applies it to a volume.

#include <cstdint>
#include <string>

namespace palpate::io {

enum class FilterType : std::uint8_t {
  none,
  gaussian,        ///< mean of the neighborhood, in all three directions: less noise, softer edges
  median,          ///< of a square of voxels in the slice: takes single wrong voxels away, keeps straight edges
  bilateral,       ///< mean of those neighbors in the slice whose values are alike: keeps edges above the noise
  non_local_means  ///< mean of places in the slice whose surroundings look alike: the slowest
};

/// Whether a filter of that type reads sigma_mm; sigma_value.
constexpr bool reads_sigma_mm(FilterType type) {
  return type == FilterType::gaussian || type == FilterType::bilateral;
}
constexpr bool reads_sigma_value(FilterType type) {
  return type == FilterType::bilateral || type == FilterType::non_local_means;
}

/// Every type reads some of these.
struct Filter {
  FilterType type = FilterType::none;
  double sigma_mm = 1;      ///< gaussian, bilateral: standard deviation of the weights over the distance
  int width = 3;            ///< median: voxels along an edge of the square, 3 or 5
  double sigma_value = 30;  ///< bilateral, non_local_means: values that differ by less are alike; the scan's unit

  /// Of what the type reads.
  bool operator==(const Filter& other) const noexcept;
};

/// "Gaussian filter of 1 mm"; "no filter".
std::string in_words(const Filter& filter);

/// Throws std::invalid_argument that names what cannot be: "sigma_mm: 0 mm is no width; give 0.1 to 10 mm".
void validate(const Filter& filter);

}  // namespace palpate::io
