#include "plugin/paraview/client/views/octahedron_directions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate::plugin {
namespace {

double degrees_between(const Direction& a, const Direction& b) {
  const double along = double{a[0]} * b[0] + double{a[1]} * b[1] + double{a[2]} * b[2];
  return std::acos(std::min(1.0, along)) * 180 / 3.14159265358979;
}

TEST(OctahedronDirections, AreKeptWithinLessThanADegree) {
  std::mt19937 random(1);
  std::normal_distribution<float> part;
  for (int n = 0; n < 100000; ++n) {
    Direction direction{part(random), part(random), part(random)};
    const float length = std::hypot(direction[0], direction[1], direction[2]);
    for (float& one : direction) one /= length;
    const int code = code_of(direction.data());
    ASSERT_GE(code, 0);
    ASSERT_LT(code, direction_codes);
    ASSERT_LT(degrees_between(direction_of(code), direction), 1) << n;
  }
}

TEST(OctahedronDirections, MeetTheAxes) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0F, 1.0F}) {
      Direction direction{0, 0, 0};
      direction[static_cast<std::size_t>(axis)] = sign;
      EXPECT_LT(degrees_between(direction_of(code_of(direction.data())), direction), 1e-3);
    }
  }
}

TEST(OctahedronDirections, KeepThatThereIsNone) {
  const Direction none{0, 0, 0};
  EXPECT_EQ(direction_of(code_of(none.data())), none);
}

TEST(OctahedronDirections, AreAllInTheTable) {
  ASSERT_EQ(decoded_directions().size(), std::size_t{3} * direction_codes);
  for (const int code : {0, 77, 32512, 65024, 65535}) {
    for (std::size_t part = 0; part < 3; ++part) {
      EXPECT_EQ(decoded_directions()[3 * static_cast<std::size_t>(code) + part], direction_of(code)[part]);
    }
  }
}

}  // namespace
}  // namespace palpate::plugin
