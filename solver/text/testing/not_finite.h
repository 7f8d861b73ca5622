#pragma once

/// The doubles that are not finite, for tests.

#include <limits>

namespace palpate {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace palpate
