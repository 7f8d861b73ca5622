#include "io/structures/color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace palpate::io {

std::string color_of_rgb(const std::vector<double>& rgb) {
  if (rgb.size() < 3) {
    return {};
  }
  std::array<char, 16> text{};
  const auto byte = [&](std::size_t n) { return static_cast<unsigned>(std::lround(std::clamp(rgb[n], 0.0, 255.0))); };
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", byte(0), byte(1), byte(2));
  return text.data();
}

std::string color_of_lab(const std::vector<double>& encoded) {
  if (encoded.size() < 3) {
    return {};
  }
  const double l = encoded[0] / 65535 * 100;
  const double a = encoded[1] / 65535 * 255 - 128;
  const double b = encoded[2] / 65535 * 255 - 128;
  // CIELAB to XYZ (D50, the profile connection space) to linear sRGB (Bradford-adapted).
  const double fy = (l + 16) / 116;
  const auto back = [](double t) { return t > 6.0 / 29 ? t * t * t : 3 * (6.0 / 29) * (6.0 / 29) * (t - 4.0 / 29); };
  const double x = 0.9642 * back(fy + a / 500);
  const double y = back(fy);
  const double z = 0.8249 * back(fy - b / 200);
  const std::array<double, 3> linear{3.1338561 * x - 1.6168667 * y - 0.4906146 * z,
                                     -0.9787684 * x + 1.9161415 * y + 0.0334540 * z,
                                     0.0719453 * x - 0.2289914 * y + 1.4052427 * z};
  std::vector<double> rgb;
  rgb.reserve(linear.size());
  for (const double c : linear) {
    rgb.push_back(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055));
  }
  return color_of_rgb(rgb);
}

}  // namespace palpate::io
