/// Sums and products of two doubles against numbers of 113 binary digits, which hold both without any rounding.
#include "solver/exact/double_double.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "solver/exact/testing/quad.h"

namespace palpate::solver::internal {
namespace {

/// Of all 53 digits, in a range of some 30 powers of two.
class AnyDouble {
 public:
  double operator()() {
    const double digits = std::ldexp(static_cast<double>((1ULL << 52) + (random_() >> 12)), -52);
    return std::ldexp(random_() % 2 == 0 ? digits : -digits, static_cast<int>(random_() % 30) - 15);
  }
  /// `lo` is below half of the last digit of `hi`.
  DoubleDouble pair() {
    const double hi = (*this)();
    return two_sum(hi, std::ldexp((*this)(), -72));
  }

 private:
  std::mt19937_64 random_{5};
};

TEST(DoubleDouble, SumsAndProductsOfTwoDoublesAreExact) {
  AnyDouble any;
  for (int n = 0; n < 100'000; ++n) {
    const double a = any(), b = any();
    ASSERT_TRUE(quad(two_sum(a, b)) == Quad(a) + Quad(b)) << a << ' ' << b;
    ASSERT_TRUE(quad(two_product(a, b)) == Quad(a) * Quad(b)) << a << ' ' << b;
    ASSERT_EQ(two_product(a, b).hi, a * b);
    const double large = std::abs(a) < std::abs(b) ? b : a, small = std::abs(a) < std::abs(b) ? a : b;
    ASSERT_TRUE(quad(quick_two_sum(large, small)) == Quad(a) + Quad(b)) << a << ' ' << b;
  }
}

TEST(DoubleDouble, OperatorsErrByLessThanTheySay) {
  AnyDouble any;
  constexpr double allowed = 0x1p-102;
  const auto magnitude = [](Quad q) { return std::abs(static_cast<double>(q)); };
  for (int n = 0; n < 100'000; ++n) {
    const DoubleDouble a = any.pair(), b = any.pair();
    const double c = any();
    const double sizes = std::abs(a.hi) + std::abs(b.hi);
    ASSERT_LE(magnitude(quad(a + b) - (quad(a) + quad(b))), allowed * sizes);
    ASSERT_LE(magnitude(quad(a - b) - (quad(a) - quad(b))), allowed * sizes);
    ASSERT_LE(magnitude(quad(a + c) - (quad(a) + Quad(c))), allowed * (std::abs(a.hi) + std::abs(c)));
    ASSERT_LE(magnitude(quad(a * b) - quad(a) * quad(b)), allowed * std::abs(a.hi * b.hi));
    ASSERT_LE(magnitude(quad(a * c) - quad(a) * Quad(c)), allowed * std::abs(a.hi * c));
    ASSERT_LE(magnitude(quad(a / b) - quad(a) / quad(b)), 4 * allowed * std::abs(a.hi / b.hi));
  }
}

}  // namespace
}  // namespace palpate::solver::internal
