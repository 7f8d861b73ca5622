#pragma once

/// Directions as 16-bit numbers for VTK's ray caster, by unfolding an octahedron. VTK's own encoders compute angles,
/// which take half of the time of a volume's gradients. (Meyer and others, "On floating-point normal vectors", 2010.)

#include <array>
#include <vector>

namespace palpate::plugin {

/// A unit vector, or zero.
using Direction = std::array<float, 3>;

constexpr int direction_codes = 65536;

/// 0 to direction_codes - 1. The error of the decoded direction is less than a degree.
int code_of(const float* direction);
Direction direction_of(int code);
/// All of them, one after the other.
const std::vector<float>& decoded_directions();

}  // namespace palpate::plugin
