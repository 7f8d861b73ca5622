#pragma once

/// Numbers of 113 binary digits: they hold a double-double's sums and products almost without rounding.

#include "solver/exact/double_double.h"

namespace palpate::solver::internal {

__extension__ typedef __float128 Quad;  // NOLINT(modernize-use-using)

/// Exact if the two parts span no more than 113 digits.
inline Quad quad(const DoubleDouble& a) {
  return Quad(a.hi) + Quad(a.lo);
}

}  // namespace palpate::solver::internal
