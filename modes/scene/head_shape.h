#pragma once

/// Whether a scan without HU has the build of a head.
///
/// The signal of an MR has no unit, but a head has a build of its own: a bright scalp, the dark skull beneath it, and
/// the bright brain. A ray from side to side, or from front to back, shows it at each of its ends. A phantom filled
/// with fluid has no such shell, and a chest has one that is too thick.

#include "io/volume.h"

namespace palpate::modes::internal {

struct Shell {
  double share = 0;     ///< of the ends of rays through a body of 100 mm or more: the part that crosses a shell
  double width_mm = 0;  ///< mean length of these rays within the body
};

/// `bright_from`: the value at which the darkest tissue, such as air and bone, ends. A scan longer than 700 mm has no
/// shell.
Shell shell_of(const io::Volume& volume, double bright_from);

/// The header's body part is asked first: a scan of another part is no head. A scan that its header calls a head needs
/// some of the shell. If the header names no part, the scan needs most of the shell, and the width of a head.
bool is_built_like_a_head(const io::Volume& volume, double bright_from);

}  // namespace palpate::modes::internal
