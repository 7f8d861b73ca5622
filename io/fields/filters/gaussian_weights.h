#pragma once

namespace palpate::io::internal {

inline constexpr double gaussian_reach = 3;  ///< radius of the kernel, standard deviations

}  // namespace palpate::io::internal
