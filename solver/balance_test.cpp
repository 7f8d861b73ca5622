#include "solver/balance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "solver/testing/values.h"

namespace palpate::solver {
namespace {

using ::testing::HasSubstr;

std::optional<Rejection> check(const Primitive& flawed) {
  const std::array primitives{make_plane(1, {0, 0, 0}, {1, 0, 0}), flawed};
  return validate({400, Vec3{0}, Vec3{0}, primitives});
}

TEST(Balance, CouplingPullsTheProbeTowardsTheProxy) {
  const Balance balance{400, {0.001, 0, 0}, Vec3{0}, {}};
  const Vec3 proxy{0.003, 0, -0.001};
  EXPECT_NEAR(coupling_force(balance, proxy).x, 0.8, 1e-15);  // -k (probe - proxy), equation (1)
  EXPECT_NEAR(coupling_force(balance, proxy).z, -0.4, 1e-15);
}

TEST(Balance, ResidualIsThePullAndTheForces) {
  const std::array primitives{make_directed_force(0.5, {0, 1, 0}), make_point(2, {0, 0, 1})};
  const Balance balance{400, {0.001, 0, 0}, Vec3{0}, primitives};
  const Vec3 epsilon = residual(balance, Vec3{0});
  EXPECT_NEAR(epsilon.x, 0.4, 1e-15);  // k (probe - proxy)
  EXPECT_NEAR(epsilon.y, 0.5, 1e-15);
  EXPECT_NEAR(epsilon.z, 2, 1e-15);
}

TEST(Balance, UsableNumbersPass) {
  EXPECT_FALSE(check(make_line(0, {1, 2, 3}, {0, 0, 5})));
  EXPECT_FALSE(check(make_point(infinity, {1, 2, 3})));
}

TEST(Balance, RubbishNamesPrimitiveAndField) {
  struct Case {
    Primitive primitive;
    Field field;
    Flaw flaw;
  };
  const Case cases[] = {
      {make_plane(-1, {0, 0, 0}, {1, 0, 0}), Field::strength, Flaw::negative},
      {make_plane(-infinity, {0, 0, 0}, {1, 0, 0}), Field::strength, Flaw::negative},
      {make_plane(nan, {0, 0, 0}, {1, 0, 0}), Field::strength, Flaw::not_finite},
      {make_directed_force(infinity, {1, 0, 0}), Field::strength, Flaw::not_finite},
      {make_plane(1e51, {0, 0, 0}, {1, 0, 0}), Field::strength, Flaw::out_of_range},
      {make_plane(1, {0, nan, 0}, {1, 0, 0}), Field::position, Flaw::not_finite},
      {make_point(1, {0, 0, infinity}), Field::position, Flaw::not_finite},
      {make_point(1, {0, 0, 1e51}), Field::position, Flaw::out_of_range},
      {make_line(1, {0, 0, 0}, {0, 0, 0}), Field::direction, Flaw::zero_direction},
      {make_directed_force(1, {0, 0, 0}), Field::direction, Flaw::zero_direction},
      {make_line(1, {0, 0, 0}, {0, nan, 0}), Field::direction, Flaw::not_finite},
  };
  for (const Case& c : cases) {
    const auto rejection = check(c.primitive);
    ASSERT_TRUE(rejection) << name_of(c.primitive.type) << " " << static_cast<int>(c.flaw);
    EXPECT_EQ(rejection->primitive, 1U);
    EXPECT_EQ(rejection->field, c.field);
    EXPECT_EQ(rejection->flaw, c.flaw);
    EXPECT_THAT(describe(*rejection), HasSubstr("primitive 1: "));
  }
}

// Of every number that has a range: the ends pass, what is just beyond is refused by its name, in every component.
TEST(Balance, RangesEndWhereTheyAreSaidToEnd) {
  const double most = largest_quantity, more = std::nextafter(most, infinity);
  const double least = 1 / most, less = std::nextafter(least, 0);
  const auto expect_end = [](const std::optional<Rejection>& at_end, const std::optional<Rejection>& beyond,
                             Field field, Flaw flaw, double value) {
    EXPECT_FALSE(at_end);
    ASSERT_TRUE(beyond);
    EXPECT_EQ(beyond->field, field);
    EXPECT_EQ(beyond->flaw, flaw);
    EXPECT_EQ(beyond->value, value);
  };
  for (int axis = 0; axis < 3; ++axis) {
    const auto along = [axis](double size) {
      Vec3 v{0};
      v[axis] = size;
      return v;
    };
    for (const double sign : {1.0, -1.0}) {
      expect_end(check(make_point(1, along(sign * most))), check(make_point(1, along(sign * more))), Field::position,
                 Flaw::out_of_range, more);
      expect_end(check(make_directed_force(1, along(sign * most))), check(make_directed_force(1, along(sign * more))),
                 Field::direction, Flaw::out_of_range, more);
      expect_end(check(make_line(1, Vec3{0}, along(sign * least))), check(make_line(1, Vec3{0}, along(sign * less))),
                 Field::direction, Flaw::zero_direction, less);
      expect_end(validate({400, along(sign * most), Vec3{0}, {}}), validate({400, along(sign * more), Vec3{0}, {}}),
                 Field::probe, Flaw::out_of_range, more);
      expect_end(validate({400, Vec3{0}, along(sign * most), {}}), validate({400, Vec3{0}, along(sign * more), {}}),
                 Field::previous_proxy, Flaw::out_of_range, more);
    }
  }
  expect_end(check(make_point(most, Vec3{0})), check(make_point(more, Vec3{0})), Field::strength, Flaw::out_of_range,
             more);
  expect_end(validate({most, Vec3{0}, Vec3{0}, {}}), validate({more, Vec3{0}, Vec3{0}, {}}), Field::stiffness,
             Flaw::out_of_range, more);
  const double softer = std::nextafter(smallest_stiffness, 0);
  expect_end(validate({smallest_stiffness, Vec3{0}, Vec3{0}, {}}), validate({softer, Vec3{0}, Vec3{0}, {}}),
             Field::stiffness, Flaw::out_of_range, softer);
}

/// The number that is told is the one that is not finite, whichever component it is.
TEST(Balance, ANumberThatIsNotFiniteIsToldAsItIs) {
  for (const double bad : {nan, infinity, -infinity}) {
    const auto expect_told = [bad](const std::optional<Rejection>& rejection, std::size_t primitive, Field field) {
      ASSERT_TRUE(rejection);
      EXPECT_EQ(rejection->primitive, primitive);
      EXPECT_EQ(rejection->field, field);
      EXPECT_EQ(rejection->flaw, Flaw::not_finite);
      EXPECT_TRUE(std::isnan(bad) ? std::isnan(rejection->value) : rejection->value == bad)
          << rejection->value << " for " << bad;
    };
    constexpr std::size_t whole = Rejection::whole_balance;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 v{0.001, -0.002, 0.003};
      v[axis] = bad;
      expect_told(validate({400, v, o, {}}), whole, Field::probe);
      expect_told(validate({400, o, v, {}}), whole, Field::previous_proxy);
      for (const Primitive& primitive : {make_plane(1, v, x), make_line(1, v, x), make_point(1, v)}) {
        expect_told(check(primitive), 1, Field::position);
      }
      for (const Primitive& primitive : {make_plane(1, o, v), make_line(1, o, v), make_directed_force(1, v)}) {
        expect_told(check(primitive), 1, Field::direction);
      }
    }
    expect_told(validate({bad, o, o, {}}), whole, Field::stiffness);
  }
  const auto strength = check(make_directed_force(infinity, x));
  ASSERT_TRUE(strength);
  EXPECT_EQ(strength->value, infinity);
}

TEST(Balance, WhatIsNotReadMayBeAnything) {
  EXPECT_FALSE(check({PrimitiveType::directed_force, 1, {nan, nan, nan}, {1, 0, 0}}));
  EXPECT_FALSE(check({PrimitiveType::point, 1, {0, 0, 0}, {0, nan, 0}}));
}

/// A stiffness that nobody has set is refused, and named.
TEST(Balance, HasNoStiffnessByItself) {
  const auto rejection = validate(Balance{});
  ASSERT_TRUE(rejection);
  EXPECT_EQ(rejection->field, Field::stiffness);
  EXPECT_EQ(rejection->flaw, Flaw::not_positive);
}

TEST(Balance, StiffnessAndProbeHaveToBeUsable) {
  EXPECT_EQ(validate({0, o, o, {}})->flaw, Flaw::not_positive);
  EXPECT_EQ(validate({-400, o, o, {}})->flaw, Flaw::not_positive);
  EXPECT_EQ(validate({nan, o, o, {}})->flaw, Flaw::not_finite);
  EXPECT_EQ(validate({infinity, o, o, {}})->flaw, Flaw::not_finite);
  EXPECT_EQ(validate({1e-60, o, o, {}})->flaw, Flaw::out_of_range);
  EXPECT_EQ(validate({400, {0, nan, 0}, o, {}})->field, Field::probe);
  EXPECT_EQ(validate({400, o, {infinity, 0, 0}, {}})->field, Field::previous_proxy);
  EXPECT_FALSE(validate({400, o, o, {}}));
}

TEST(Balance, DescriptionIsASentence) {
  EXPECT_EQ(describe({2, Field::strength, Flaw::negative, -1}), "primitive 2: strength is negative (-1)");
  EXPECT_EQ(describe({Rejection::whole_balance, Field::stiffness, Flaw::not_positive, 0}),
            "stiffness is not positive (0)");
  EXPECT_EQ(describe({1, Field::strength, Flaw::incompatible, 0.25}),
            "primitive 1: has infinite strength, but no point meets it together with the other hard constraints: it "
            "stays 0.25 m away (tolerance: 1e-12 of the largest distance between probe and constraints)");
}

/// The largest number is told of every field, the smallest of the stiffness alone: no other has one.
TEST(Balance, WhatIsOutOfRangeIsToldWithItsOwnRange) {
  constexpr std::size_t whole = Rejection::whole_balance;
  const struct {
    std::size_t primitive;
    Field field;
    const char* said;
  } cases[] = {{whole, Field::stiffness, "stiffness is out of range (1e+51): at most 1e+50, at least 1e-50"},
               {whole, Field::probe, "probe is out of range (1e+51): at most 1e+50"},
               {whole, Field::previous_proxy, "previous proxy is out of range (1e+51): at most 1e+50"},
               {2, Field::strength, "primitive 2: strength is out of range (1e+51): at most 1e+50"},
               {2, Field::position, "primitive 2: position is out of range (1e+51): at most 1e+50"},
               {2, Field::direction, "primitive 2: direction is out of range (1e+51): at most 1e+50"}};
  for (const auto& [primitive, field, said] : cases) {
    EXPECT_EQ(describe({primitive, field, Flaw::out_of_range, 1e51}), said);
  }
}

}  // namespace
}  // namespace palpate::solver
