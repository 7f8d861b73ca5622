#pragma once

/// The distance of the felt boundary from the true one against the time of a tick: `palpate-bench tick --place`.

#include <string>

namespace palpate::plugin {

/// A ball of 20 mm in voxels of 1 mm with 20 HU of noise; the probe slides along it 1 mm deep. For each interpolation,
/// gradient and sub-step length. Prints the table and returns it as CSV.
std::string run_place_study();

}  // namespace palpate::plugin
