#pragma once

/// A filter of a scan's values against noise, which a stylus feels as roughness. It is a setting of the scene;
/// fields/filtered.h applies it to a volume. Each type of filter is one file (fields/filters/<name>_filter.cpp), and
/// one name in io/CMakeLists.txt.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "io/geometry.h"

namespace cv {
class Mat;
}

namespace palpate::io {

struct FilterType;

/// Settings of a filter. Each type uses some of them.
struct Filter {
  const FilterType* type = nullptr;  ///< null: no filter
  double sigma_mm = 1;               ///< standard deviation of the weights over the distance
  int width = 3;                     ///< voxels along an edge of the square, 3 or 5
  double sigma_value = 30;           ///< values that differ by less count as equal; the scan's unit

  /// Compares the type and the settings that the type reads.
  bool operator==(const Filter& other) const noexcept;
};

struct FilterType {
  std::string_view name;     ///< as in scenes
  std::string_view title;    ///< for people
  std::string_view summary;  ///< one line for people: its effect on noise and edges
  bool reads_sigma_mm = false, reads_width = false, reads_sigma_value = false;
  bool reaches_across = false;  ///< whether a Gaussian of sigma_mm across the slices follows in_slice()
  std::string (*in_words)(const Filter& filter) = nullptr;
  /// Filters the rescaled values of one slice (CV_32F).
  cv::Mat (*in_slice)(const cv::Mat& values, const Geometry& geometry, const Filter& filter) = nullptr;
  /// Variance of the blur along a unit direction, mm^2. Null if the filter keeps edges.
  double (*blur)(const Geometry& geometry, const Filter& filter, const Vec3& direction) = nullptr;
};

/// All types of filter.
std::span<const FilterType* const> filter_types();
/// Null if no type has that name.
const FilterType* find_filter_type(std::string_view name);

/// "Gaussian filter of 1 mm"; "no filter".
std::string in_words(const Filter& filter);

/// Throws std::invalid_argument that names a setting out of range: "sigma_mm: 0 mm is no width; give 0.1 to 10 mm".
void validate(const Filter& filter);

}  // namespace palpate::io
