// Colors converted to CIELAB and back: by the standards' formulas, forwards here and backwards in the program.
#include "io/structures/color.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace palpate::io {
namespace {

/// IEC 61966-2-1 from a byte to linear light.
double linear(int byte) {
  const double c = byte / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// CIE 15: of what part of white's.
double bent(double t) {
  return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
}

/// PS3.3 C.10.7.1.1: 16 bits each for L* from 0 to 100 and a*, b* from -128 to 127; white is that of the profile
/// connection space, D50 (the matrix is sRGB's, adapted by Bradford's method).
std::vector<double> encoded(int red, int green, int blue) {
  const double r = linear(red), g = linear(green), b = linear(blue);
  const double x = bent((0.4360747 * r + 0.3850649 * g + 0.1430804 * b) / 0.9642);
  const double y = bent(0.2225045 * r + 0.7168786 * g + 0.0606169 * b);
  const double z = bent((0.0139322 * r + 0.0971045 * g + 0.7141733 * b) / 0.8249);
  const std::array lab{116 * y - 16, 500 * (x - y), 200 * (y - z)};
  return {std::round(lab[0] / 100 * 65535), std::round((lab[1] + 128) / 255 * 65535),
          std::round((lab[2] + 128) / 255 * 65535)};
}

TEST(Color, OfLabIsTheOneThatWentIn) {
  for (const int red : {0, 3, 11, 40, 128, 200, 255}) {
    for (const int green : {0, 3, 11, 40, 128, 200, 255}) {
      for (const int blue : {0, 3, 11, 40, 128, 200, 255}) {
        unsigned r = 0, g = 0, b = 0;
        const std::string color = color_of_lab(encoded(red, green, blue));
        ASSERT_EQ(color.size(), 7U);
        ASSERT_EQ(std::sscanf(color.c_str(), "#%2x%2x%2x", &r, &g, &b), 3);
        const double far = std::max({std::abs(static_cast<double>(r) - red), std::abs(static_cast<double>(g) - green),
                                     std::abs(static_cast<double>(b) - blue)});
        EXPECT_LE(far, 1) << color << " of " << red << ' ' << green << ' ' << blue;
      }
    }
  }
}

TEST(Color, OfNumbersIsRoundedAndHeldWithinItsBytes) {
  EXPECT_EQ(color_of_rgb({0, 127.4, 127.6}), "#007f80");
  EXPECT_EQ(color_of_rgb({-5, 300, 16}), "#00ff10");
  EXPECT_EQ(color_of_rgb({1, 2}), "");
  EXPECT_EQ(color_of_lab({1, 2}), "");
}

TEST(Color, GoesIntoLabByTheStandardsFormulas) {
  for (const std::array rgb : {std::array{0, 0, 0}, {255, 255, 255}, {217, 130, 101}, {3, 200, 40}, {0, 0, 255}}) {
    const std::vector<double> wanted = encoded(rgb[0], rgb[1], rgb[2]);
    const auto lab = lab_of_rgb(rgb);
    for (std::size_t n = 0; n < 3; ++n) EXPECT_NEAR(lab[n], wanted[n], 1) << n;
    const std::string color = color_of_rgb({rgb.begin(), rgb.end()});
    EXPECT_EQ(color_of_lab({lab.begin(), lab.end()}), color);
    EXPECT_EQ(rgb_of_color(color), rgb);
  }
  for (const char* const none : {"", "red", "#12345", "#1234567", "#12345g", "0#12345"}) {
    EXPECT_FALSE(rgb_of_color(none)) << none;
  }
}

}  // namespace
}  // namespace palpate::io
