#include "solver/exact/placed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "solver/exact/testing/quad.h"
#include "solver/testing/problems.h"

namespace palpate::solver::internal {
namespace {

struct QuadVector {
  Quad x, y, z;
};

Quad dot(const QuadVector& a, const QuadVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

Quad root(Quad square) {
  Quad length = std::sqrt(static_cast<double>(square));
  for (int n = 0; n < 3; ++n) length = (length + square / length) / 2;  // Newton's way
  return length;
}

constexpr double sizes[] = {1e-50, 1e-30, 1e-3, 0.4, 1, 3, 1e3, 1e30, 1e50};

/// Every vector of which one component is far larger than the others, each way, and some at random.
template <typename Check>
void for_vectors_of(double size, const Check& check) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Vec3 v{0};
      v[axis] = sign * size;
      check(v);
      v[(axis + 1) % 3] = 1e-9 * size;
      check(v);
    }
  }
  Random random(1);
  for (int n = 0; n < 50; ++n) check(size * random.unit_vector());
}

TEST(Placed, LengthsAreExactAtAnySize) {
  Random random(2);
  for (int exponent = -300; exponent <= 300; ++exponent) {
    const double size = std::pow(10, exponent);
    const Vec3 unit = random.unit_vector();
    EXPECT_NEAR(length_of(unit * size) / size, glm::length(unit), 2e-15) << exponent;
  }
}

TEST(Placed, DirectionsOfAnyLengthMeanTheSame) {
  for (const double size : sizes) {
    for_vectors_of(size, [&](const Vec3& v) {
      Placed placed;
      place(make_line(1, {1, 2, 3}, v), {0, 0, 0}, placed);
      const Vec3 unit = v / size / glm::length(v / size);
      EXPECT_LT(glm::length(placed.direction - unit), 1e-15) << size;
      EXPECT_NEAR(placed.given_length, glm::length(placed.given_direction), 1e-15 * placed.given_length) << size;
      EXPECT_GE(placed.given_length, 0.5) << size;
      EXPECT_LE(placed.given_length, 3.5) << size;
      // A power of two: nothing is rounded.
      const double times = placed.given_length / glm::length(v / size) / size;
      const double power = std::round(std::log2(times));
      for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(placed.given_direction[axis], std::ldexp(v[axis], int(power)));
    });
  }
}

// In 113 binary digits. Errors are stated beside what a double rounds of the distance, and a double-double of the
// place.
TEST(Placed, DistancesAreWrongByNoMoreThanTheySay) {
  Random random(7);
  for (int n = 0; n < 20000; ++n) {
    const double far = random.log_uniform(1e-6, 1e5), off = far * random.log_uniform(1e-25, 1);
    const Vec3 at = far * random.unit_vector(), way = random.unit_vector();
    const Primitive primitive = n % 3 == 0   ? make_plane(1, at, way * 3.0)
                                : n % 3 == 1 ? make_line(1, at, way * 0.4)
                                             : make_point(1, at);
    Placed placed;
    place(primitive, {0.1, 0.2, 0.3}, placed);
    const FineVec3 beside = fine(off * random.unit_vector());
    const FineVec3 z = placed.offset - beside - fine(primitive.direction) * (n % 3 == 1 ? off : 0);
    const QuadVector e{quad(placed.offset.x) - quad(z.x), quad(placed.offset.y) - quad(z.y),
                       quad(placed.offset.z) - quad(z.z)};
    const double own = 0x1p-100 * (far + 0.5);  // the probe is at 0.4
    const Vec3& d = primitive.direction;
    const QuadVector q{d.x, d.y, d.z};
    if (primitive.type == PrimitiveType::plane) {
      const Quad exact = dot(e, q) / root(dot(q, q));
      for (const Depth& depth : {depth_of(placed, z), fine_depth_of(placed, z)}) {
        const double wrong = std::abs(static_cast<double>(Quad(depth.value) - exact));
        ASSERT_LE(wrong, depth.error + own + 4e-16 * std::abs(depth.value)) << n << ' ' << far << ' ' << off;
      }
      continue;
    }
    const bool is_line = primitive.type == PrimitiveType::line;
    const Quad along = is_line ? dot(e, q) / dot(q, q) : 0;
    const QuadVector exact{e.x - along * q.x, e.y - along * q.y, e.z - along * q.z};
    for (const Miss& miss : {miss_of(placed, z), quick_miss_of(placed, z), fine_miss_of(placed, z)}) {
      const QuadVector wrong{quad(miss.vector.x) - exact.x, quad(miss.vector.y) - exact.y,
                             quad(miss.vector.z) - exact.z};
      ASSERT_LE(static_cast<double>(root(dot(wrong, wrong) + Quad(1e-300))), miss.error + own + 4e-16 * miss.length)
          << n;
      ASSERT_NEAR(miss.length, static_cast<double>(root(dot(exact, exact))), miss.error + own + 4e-16 * miss.length)
          << n;
    }
  }
}

TEST(Placed, LengthsDoNotOverflow) {
  for (const double size : {1e-300, 1e-200, 1e-145, 1e-140, 1.0, 1e140, 1e145, 1e200, 1e300}) {
    for_vectors_of(size, [&](const Vec3& v) {
      const double length = size * glm::length(v / size);
      EXPECT_NEAR(length_of(v) / length, 1, 1e-15) << size;
      EXPECT_NEAR(scaled_length_of(v) / length, 1, 1e-15) << size;
    });
  }
  EXPECT_EQ(scaled_length_of(Vec3{0}), 0);
}

}  // namespace
}  // namespace palpate::solver::internal
