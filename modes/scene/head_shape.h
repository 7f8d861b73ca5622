#pragma once

/// Whether a scan without HU shows a head.
///
/// The signal of an MR has no unit, but a head has a typical structure: a bright scalp, the dark skull beneath it, and
/// the bright brain. A ray from side to side, or from front to back, shows it at each of its ends. A phantom filled
/// with fluid has no such shell, and a chest has one that is too thick.

#include "io/volume.h"

namespace palpate::modes::internal {

struct Shell {
  double share = 0;     ///< part of the ray ends that cross a shell, for rays with 100 mm or more in the body
  double width_mm = 0;  ///< mean length of these rays within the body
};

/// `bright_from`: the value at which the darkest tissue, such as air and bone, ends. A scan longer than 700 mm has no
/// shell.
Shell shell_of(const io::Volume& volume, double bright_from);

/// The header's body part is read first: a scan of another part shows no head. If the header names the head, a part of
/// the shell is enough. If it names no part, the scan must show most of the shell, and the width of a head.
bool is_built_like_a_head(const io::Volume& volume, double bright_from);

}  // namespace palpate::modes::internal
