#pragma once

#include <string>
#include <vector>

namespace palpate::io {

/// "#rrggbb" of RecommendedDisplayCIELabValue (PS3.3 C.10.7.1.1); empty where there are not three numbers.
std::string color_of_lab(const std::vector<double>& encoded);

/// "#rrggbb" of three numbers from 0 to 255; empty where there are not three.
std::string color_of_rgb(const std::vector<double>& rgb);

}  // namespace palpate::io
