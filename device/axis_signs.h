#pragma once

#include "device/stylus.h"

namespace palpate::device {

/// Corrections of the directions of a device's axes: 1, or -1 if an axis runs against its driver. They apply in the
/// device frame. `palpate devices --check` finds them and writes them into a settings file.
struct AxisSigns {
  Vec3 position{1};
  Vec3 force{1};
};

}  // namespace palpate::device
