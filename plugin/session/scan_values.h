#pragma once

#include "io/volume.h"

namespace palpate::plugin {

/// The same volume with slope 1 and intercept 0. It stays 16 bit if every value is an integer that fits (all CT);
/// otherwise the voxels become floats. Everything that is felt is felt of this form, in ParaView and on the command
/// line: otherwise one could not repeat a recording of the other to the last bit. Takes the volume's voxels.
io::Volume scan_values(io::Volume volume);

}  // namespace palpate::plugin
