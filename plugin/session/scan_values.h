#pragma once

#include "io/volume.h"

namespace palpate::plugin {

/// The same volume with slope 1 and intercept 0: still 16 bit where every value is an integer that fits (all CT), else
/// as floats. A viewer shows what is stored; and whatever is felt is felt of this form, in ParaView and on the command
/// line, or the one could not repeat the other's recordings to the last bit. Takes its voxels.
io::Volume scan_values(io::Volume volume);

}  // namespace palpate::plugin
