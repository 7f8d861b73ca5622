#pragma once

/// Rows of the study with a known exact answer: a phantom whose boundaries are known exactly.

#include <cstdint>
#include <vector>

#include "plugin/bench/force_study.h"
#include "testdata/phantom.h"

namespace palpate::plugin {

/// A body of fat around muscle, which contains a liver, a lung, a bone with marrow and a vessel with contrast medium.
/// All are balls that do not touch.
testdata::Phantom make_torso();

/// The distance from the nearest surface of the torso, mm.
double torso_surface_mm(const glm::dvec3& place_mm);

/// Scans of the torso (noise, blur, spacing, tilt), the filters of a scene, and the solvers. `seed`: of the noise.
std::vector<ForceGroup> phantom_groups(std::uint64_t seed);

}  // namespace palpate::plugin
