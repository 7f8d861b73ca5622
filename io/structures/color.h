#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpate::io {

/// "#rrggbb" of RecommendedDisplayCIELabValue (PS3.3 C.10.7.1.1); empty if there are not three numbers.
std::string color_of_lab(const std::vector<double>& encoded);

/// "#rrggbb" of three numbers from 0 to 255; empty if there are not three.
std::string color_of_rgb(const std::vector<double>& rgb);

/// Red, green and blue, 0 to 255, of "#rrggbb"; nothing for any other text.
std::optional<std::array<int, 3>> rgb_of_color(const std::string& color);

/// RecommendedDisplayCIELabValue of red, green and blue; the inverse of color_of_lab().
std::array<std::uint16_t, 3> lab_of_rgb(const std::array<int, 3>& rgb);

}  // namespace palpate::io
