#pragma once

/// Values from which tests build their balances.

#include "solver/primitive.h"
#include "solver/text/testing/not_finite.h"

namespace palpate::solver {

inline constexpr double mm = 1e-3;  ///< m

inline constexpr Vec3 x{1, 0, 0};
inline constexpr Vec3 y{0, 1, 0};
inline constexpr Vec3 z{0, 0, 1};
inline constexpr Vec3 o{0};

}  // namespace palpate::solver
