#pragma once

#include <optional>

#include "io/progress.h"
#include "io/series.h"
#include "io/volume.h"

namespace palpate::io {

struct LoadOptions {
  int frame = 0;      ///< one of frames_per_position
  Progress progress;  ///< may be empty
  int threads = 0;    ///< 0: all cores
  /// Loads only these slices, numbered along the frame's geometry. Step and form of the values are those of the whole
  /// frame. Not for velocity fields, which are loaded whole.
  struct Range {
    int first = 0;
    int count = 0;
  };
  std::optional<Range> slices;
  /// Gives the values as rescaled() does. Every force is computed from values in this form, in ParaView and on the
  /// command line; otherwise a recording of one could not be replayed in the other to the last bit.
  bool is_rescaled = false;
};

/// The voxels of one frame of a series: stored values, with the slope and intercept in Volume, or rescaled values if
/// requested. A velocity field (Catalogue::velocity_fields) gives its three directions and the speed, m/s. Decodes
/// files in parallel, and needs little more memory than the volume. A slice that cannot be decoded becomes a gap and is
/// named in Volume::warnings. Throws DicomError if nothing can be read, or if the series has no scalar images with a
/// position. Throws Cancelled.
Volume load(const Series& series, const LoadOptions& options = {});

}  // namespace palpate::io
