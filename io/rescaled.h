#pragma once

#include "io/volume.h"

namespace palpate::io {

/// The same volume with slope 1 and intercept 0. It stays 16 bit if every value is an integer that fits (all CT);
/// otherwise the voxels become floats. Takes the volume's voxels.
Volume rescaled(Volume volume);

}  // namespace palpate::io
