#pragma once

namespace palpate::io::internal {

inline constexpr double gaussian_reach = 3;  ///< of its weights, standard deviations

}  // namespace palpate::io::internal
