#include "io/structures/cubic.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <random>

namespace palpate::io {
namespace {

constexpr std::ptrdiff_t row = 5, plane = 27;
using Numbers = std::array<float, 4 * plane>;

std::array<std::uint64_t, 4> bits_of(const CubicSample& sample) {
  return {std::bit_cast<std::uint64_t>(sample.value), std::bit_cast<std::uint64_t>(sample.slope[0]),
          std::bit_cast<std::uint64_t>(sample.slope[1]), std::bit_cast<std::uint64_t>(sample.slope[2])};
}

glm::dvec3 any_part(std::mt19937& random) {
  std::uniform_real_distribution<double> part(0, 1);
  const auto one = [&] { return random() % 8 == 0 ? static_cast<double>(random() % 2) : part(random); };
  const double x = one(), y = one(), z = one();
  return {x, y, z};
}

// Else a session would not repeat on another processor.
TEST(Cubic, HasTheSameBitsOnEveryProcessor) {
  std::mt19937 random(41);
  for (int trial = 0; trial < 20000; ++trial) {
    const float size = trial % 3 == 0 ? 1e-6F : trial % 3 == 1 ? 30.0F : 1e12F;
    std::uniform_real_distribution<float> any(-size, size);
    Numbers numbers{};
    for (float& number : numbers) number = random() % 16 == 0 ? -0.0F : any(random);
    const glm::dvec3 t = any_part(random);
    EXPECT_EQ(bits_of(cubic_sample(numbers.data(), row, plane, t)),
              bits_of(plain_cubic_sample(numbers.data(), row, plane, t.x, t.y, t.z)))
        << trial;
  }
}

TEST(Cubic, KeepsTheSignOfZeroOnEveryProcessor) {
  Numbers numbers{};
  for (int trial = 0; trial < 2; ++trial) {
    numbers.fill(trial == 0 ? 0.0F : -0.0F);
    for (const glm::dvec3 t : {glm::dvec3(0), glm::dvec3(0.25, 0.5, 0.75), glm::dvec3(1)}) {
      EXPECT_EQ(bits_of(cubic_sample(numbers.data(), row, plane, t)),
                bits_of(plain_cubic_sample(numbers.data(), row, plane, t.x, t.y, t.z)));
    }
  }
}

// Keys: cubic convolution with a = -1/2 is exact for polynomials of second degree, and so are its slopes.
TEST(Cubic, IsExactForPolynomialsOfSecondDegree) {
  std::mt19937 random(42);
  for (int trial = 0; trial < 200; ++trial) {
    double factor[3][3];
    for (auto& axis : factor) {
      for (double& one : axis) one = static_cast<double>(random() % 9) - 4;
    }
    const auto along = [&](int axis, double at) {
      return factor[axis][0] + at * (factor[axis][1] + at * factor[axis][2]);
    };
    const auto slope = [&](int axis, double at) { return factor[axis][1] + 2 * at * factor[axis][2]; };
    Numbers numbers{};
    for (int k = 0; k < 4; ++k) {
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {  // whole numbers that a float holds
          numbers[static_cast<std::size_t>(k * plane + j * row + i)] =
              static_cast<float>(along(0, i - 1) * along(1, j - 1) * along(2, k - 1));
        }
      }
    }
    const glm::dvec3 t = any_part(random);
    const double x = along(0, t.x), y = along(1, t.y), z = along(2, t.z);
    for (const CubicSample& sample :
         {cubic_sample(numbers.data(), row, plane, t), plain_cubic_sample(numbers.data(), row, plane, t.x, t.y, t.z)}) {
      constexpr double rounding = 1e-10;
      EXPECT_NEAR(sample.value, x * y * z, rounding);
      EXPECT_NEAR(sample.slope[0], slope(0, t.x) * y * z, rounding);
      EXPECT_NEAR(sample.slope[1], x * slope(1, t.y) * z, rounding);
      EXPECT_NEAR(sample.slope[2], x * y * slope(2, t.z), rounding);
    }
  }
}

TEST(Cubic, IsNotANumberWhereANeighborIsNone) {
  Numbers numbers{};
  numbers[plane + row] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(cubic_sample(numbers.data(), row, plane, glm::dvec3(0.5)).value,
            cubic_sample(numbers.data(), row, plane, glm::dvec3(0.5)).value);
}

}  // namespace
}  // namespace palpate::io
