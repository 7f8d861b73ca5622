#pragma once

/// Unevaluated sums of two doubles (T. J. Dekker 1971; D. E. Knuth, TAOCP 2, 4.2.2): about 31 significant digits, from
/// error-free transformations. Used for a distance to a primitive that is small because large terms cancel.

#include <cmath>
#include <glm/vec3.hpp>

namespace palpate::solver::internal {

using Vec3 = glm::dvec3;

/// The largest relative change of a number by its rounding to a double.
inline constexpr double unit_roundoff = 0x1p-53;

struct DoubleDouble {
  double hi;
  double lo;
};

/// a + b = hi + lo exactly.
inline DoubleDouble two_sum(double a, double b) {
  const double hi = a + b;
  const double b_part = hi - a;
  return {hi, (a - (hi - b_part)) + (b - b_part)};
}

/// The same if |a| >= |b|.
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

/// a / b.
inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double first = a.hi / b.hi;
  const DoubleDouble rest = a - b * first;
  return quick_two_sum(first, rest.hi / b.hi);
}

/// A vector of double-doubles.
struct FineVec3 {
  DoubleDouble x;
  DoubleDouble y;
  DoubleDouble z;

  Vec3 hi() const { return {x.hi, y.hi, z.hi}; }
};

inline FineVec3 fine(const Vec3& v) {
  return {{v.x, 0}, {v.y, 0}, {v.z, 0}};
}

/// a - b exactly.
inline FineVec3 exact_difference(const Vec3& a, const Vec3& b) {
  return {two_sum(a.x, -b.x), two_sum(a.y, -b.y), two_sum(a.z, -b.z)};
}
inline FineVec3 operator+(const FineVec3& a, const FineVec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline FineVec3 operator+(const FineVec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline FineVec3 operator-(const FineVec3& a, const FineVec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline FineVec3 operator*(const FineVec3& a, double b) {
  return {a.x * b, a.y * b, a.z * b};
}

/// a b with an exact vector of doubles.
inline FineVec3 operator*(const Vec3& a, const DoubleDouble& b) {
  return {b * a.x, b * a.y, b * a.z};
}
inline DoubleDouble dot(const FineVec3& a, const Vec3& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

}  // namespace palpate::solver::internal
