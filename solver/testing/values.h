#pragma once

/// Values from which tests make up their balances.

#include <limits>

#include "solver/primitive.h"

namespace palpate::solver {

inline constexpr double mm = 1e-3;  ///< m
inline constexpr double infinity = std::numeric_limits<double>::infinity();

inline constexpr Vec3 x{1, 0, 0};
inline constexpr Vec3 y{0, 1, 0};
inline constexpr Vec3 z{0, 0, 1};
inline constexpr Vec3 o{0};

}  // namespace palpate::solver
