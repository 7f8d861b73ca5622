#pragma once

/// The names of enumerators in scenes, both ways.

#include <array>
#include <string>
#include <string_view>

#include "modes/scene/scene.h"

namespace palpate::modes {

template <typename Enum>
struct Named {
  Enum value;
  std::string_view name;
};

inline constexpr std::array datum_names{Named<Datum>{Datum::value, "value"},
                                        Named<Datum>{Datum::gradient_magnitude, "gradient_per_mm"},
                                        Named<Datum>{Datum::vector_magnitude, "vector"},
                                        Named<Datum>{Datum::low, "low"},
                                        Named<Datum>{Datum::high, "high"},
                                        Named<Datum>{Datum::distance, "distance_mm"}};
inline constexpr std::array side_names{Named<Side>{Side::entering, "entering"}, Named<Side>{Side::leaving, "leaving"},
                                       Named<Side>{Side::both, "both"}};
inline constexpr std::array direction_field_names{Named<DirectionField>{DirectionField::vector, "vector"},
                                                  Named<DirectionField>{DirectionField::gradient, "gradient"}};
inline constexpr std::array shape_names{Named<Shape>{Shape::point, "point"}, Named<Shape>{Shape::line, "line"},
                                        Named<Shape>{Shape::plane, "plane"}};
inline constexpr std::array interpolation_names{Named<Interpolation>{Interpolation::linear, "linear"},
                                                Named<Interpolation>{Interpolation::monotone_cubic, "monotone_cubic"}};

inline constexpr std::array value_method_names{Named<io::ValueMethod>{io::ValueMethod::cubic, "cubic"},
                                               Named<io::ValueMethod>{io::ValueMethod::trilinear, "trilinear"}};
inline constexpr std::array gradient_method_names{
    Named<io::GradientMethod>{io::GradientMethod::gaussian, "gaussian"},
    Named<io::GradientMethod>{io::GradientMethod::central_differences, "central_differences"},
    Named<io::GradientMethod>{io::GradientMethod::cubic, "cubic"}};
template <typename Names, typename Enum>
std::string name_in(const Names& names, Enum value) {
  for (const auto& entry : names) {
    if (entry.value == value) {
      return std::string(entry.name);
    }
  }
  return {};
}

}  // namespace palpate::modes
