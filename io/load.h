#pragma once

#include <optional>

#include "io/progress.h"
#include "io/series.h"
#include "io/volume.h"

namespace palpate::io {

struct LoadOptions {
  int frame = 0;      ///< which of frames_per_position
  Progress progress;  ///< may be empty
  int threads = 0;    ///< 0: all cores
  /// Some slices only, counted along the geometry of the frame: its step, and its values in the same form as of the
  /// whole. Not for velocity fields, which are loaded whole.
  struct Range {
    int first = 0;
    int count = 0;
  };
  std::optional<Range> slices;
};

/// The voxels of one frame of a series, rescaled as Volume says; of a velocity field (Catalogue::velocity_fields), the
/// three directions and the speed, m/s. Decodes files in parallel; needs little more memory
/// than the volume. A slice that cannot be decoded is left out as a gap and named in Volume::warnings. Throws
/// DicomError where nothing can be read or the series holds no scalar, placed images; Cancelled.
Volume load(const Series& series, const LoadOptions& options = {});

}  // namespace palpate::io
