#pragma once

/// Unevaluated sums of two doubles (T. J. Dekker 1971; D. E. Knuth, TAOCP 2, 4.2.2): about 31 significant digits, from
/// error-free transformations, where a distance to a primitive is what is left of a cancellation.

#include <cmath>
#include <glm/vec3.hpp>

namespace palpate::solver::internal {

using Vec3 = glm::dvec3;

struct DoubleDouble {
  double hi = 0;
  double lo = 0;
};

/// a + b = hi + lo exactly.
inline DoubleDouble two_sum(double a, double b) {
  const double hi = a + b;
  const double b_part = hi - a;
  return {hi, (a - (hi - b_part)) + (b - b_part)};
}

/// The same where |a| >= |b|.
inline DoubleDouble quick_two_sum(double a, double b) {
  const double hi = a + b;
  return {hi, b - (hi - a)};
}

/// a b = hi + lo exactly (while nothing over- or underflows). Both branches give the same bits.
inline DoubleDouble two_product(double a, double b) {
  const double hi = a * b;
#ifdef __FMA__
  return {hi, std::fma(a, b, -hi)};
#else
  const double splitter = 134217729;  // 2^27 + 1
  const double a_scaled = splitter * a;
  const double b_scaled = splitter * b;
  const double a_hi = a_scaled - (a_scaled - a);
  const double b_hi = b_scaled - (b_scaled - b);
  const double a_lo = a - a_hi;
  const double b_lo = b - b_hi;
  return {hi, ((a_hi * b_hi - hi) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo};
#endif
}

// The error of the following is below 2^-102 of the sum of the operands' magnitudes (sums) or of the result (products).

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble sum = two_sum(a.hi, b.hi);
  return quick_two_sum(sum.hi, sum.lo + (a.lo + b.lo));
}
inline DoubleDouble operator+(const DoubleDouble& a, double b) {
  const DoubleDouble sum = two_sum(a.hi, b);
  return quick_two_sum(sum.hi, sum.lo + a.lo);
}
inline DoubleDouble operator-(const DoubleDouble& a) {
  return {-a.hi, -a.lo};
}
inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
  return a + -b;
}
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = two_product(a.hi, b.hi);
  return quick_two_sum(product.hi, product.lo + (a.hi * b.lo + a.lo * b.hi));
}
inline DoubleDouble operator*(const DoubleDouble& a, double b) {
  const DoubleDouble product = two_product(a.hi, b);
  return quick_two_sum(product.hi, product.lo + a.lo * b);
}

/// 1 / sqrt(a), a > 0: one step of Newton's method from the double result.
inline DoubleDouble inverse_sqrt(const DoubleDouble& a) {
  const double start = 1 / std::sqrt(a.hi);
  const DoubleDouble miss = DoubleDouble{1, 0} - a * two_product(start, start);
  return quick_two_sum(start, 0.5 * start * miss.hi);
}

/// A vector of double-doubles.
struct FineVec3 {
  Vec3 hi{0};
  Vec3 lo{0};

  DoubleDouble operator[](int i) const { return {hi[i], lo[i]}; }
  void set(int i, const DoubleDouble& value) {
    hi[i] = value.hi;
    lo[i] = value.lo;
  }
};

/// a - b exactly.
inline FineVec3 exact_difference(const Vec3& a, const Vec3& b) {
  FineVec3 result;
  for (int i = 0; i < 3; ++i) {
    result.set(i, two_sum(a[i], -b[i]));
  }
  return result;
}
inline FineVec3 operator+(const FineVec3& a, const FineVec3& b) {
  FineVec3 result;
  for (int i = 0; i < 3; ++i) {
    result.set(i, a[i] + b[i]);
  }
  return result;
}
inline FineVec3 operator+(const FineVec3& a, const Vec3& b) {
  FineVec3 result;
  for (int i = 0; i < 3; ++i) {
    result.set(i, a[i] + b[i]);
  }
  return result;
}
inline FineVec3 operator-(const FineVec3& a, const FineVec3& b) {
  FineVec3 result;
  for (int i = 0; i < 3; ++i) {
    result.set(i, a[i] - b[i]);
  }
  return result;
}
inline FineVec3 operator*(const FineVec3& a, const DoubleDouble& b) {
  FineVec3 result;
  for (int i = 0; i < 3; ++i) {
    result.set(i, a[i] * b);
  }
  return result;
}
inline FineVec3 operator*(const FineVec3& a, double b) {
  FineVec3 result;
  for (int i = 0; i < 3; ++i) {
    result.set(i, a[i] * b);
  }
  return result;
}
inline DoubleDouble dot(const FineVec3& a, const FineVec3& b) {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

}  // namespace palpate::solver::internal
