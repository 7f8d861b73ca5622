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

std::optional<std::array<int, 3>> rgb_of_color(const std::string& color) {
  constexpr std::size_t length = 7;
  if (color.size() != length || color.front() != '#' ||
      color.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos) {
    return std::nullopt;
  }
  const auto part = [&](std::size_t at) { return std::stoi(color.substr(at, 2), nullptr, 16); };
  return std::array{part(1), part(3), part(5)};
}

std::array<std::uint16_t, 3> lab_of_rgb(const std::array<int, 3>& rgb) {
  std::array<double, 3> linear{};
  for (std::size_t n = 0; n < 3; ++n) {
    const double c = rgb[n] / 255.0;
    linear[n] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  // Linear sRGB to XYZ (D50, Bradford-adapted) to CIELAB: the inverse of color_of_lab().
  const auto& [r, g, b] = linear;
  const auto forth = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  const double x = forth((0.4360747 * r + 0.3850649 * g + 0.1430804 * b) / 0.9642);
  const double y = forth(0.2225045 * r + 0.7168786 * g + 0.0606169 * b);
  const double z = forth((0.0139322 * r + 0.0971045 * g + 0.7141733 * b) / 0.8249);
  const auto encoded = [](double share) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * 65535));
  };
  return {encoded((116 * y - 16) / 100), encoded((500 * (x - y) + 128) / 255), encoded((200 * (y - z) + 128) / 255)};
}

}  // namespace palpate::io
