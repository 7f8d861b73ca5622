#pragma once

/// Reads the slices of a frame into a volume.

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "io/dicom/series_source.h"
#include "io/volume.h"

namespace palpate::io::internal {

using Slices = std::vector<SeriesSource::Slice>;

/// What to read: the rescaled values of a frame, or the velocities (m/s) that they encode.
struct Reading {
  const SeriesSource& source;
  const SeriesSource::Frame& frame;
  bool as_velocity = false;

  struct Rescale {
    double slope = 1;
    double intercept = 0;
    bool operator==(const Rescale&) const = default;
  };
  Rescale rescale_of(const SeriesSource::Slice& slice) const;
};

/// The padding value of a float volume: far below any value, so it is valid for slices of any rescale.
constexpr float float_padding = std::numeric_limits<float>::lowest();

/// Slices from one file, in the order of its frames, as indices into the reading's slices. The file is opened once and
/// a mosaic decoded once. At most 16 frames, so that all cores share a multi-frame file; but all frames of a deflated
/// file, which can only be inflated from its start.
using SliceUnit = std::vector<std::size_t>;
std::vector<SliceUnit> slice_units(const Reading& reading);

/// Reads a unit's slices into `voxels`, which holds all slices of the reading: as stored if it has 16 bits, rescaled if
/// it holds floats. Calls failed(k, reason) for slices that cannot be read, and noted(what) for pixels that were
/// readable although their coding breaks the standard.
void read_unit(const Reading& reading, const SliceUnit& unit, Volume::Voxels& voxels,
               const std::function<void(std::size_t, const char*)>& failed,
               const std::function<void(const Text&)>& noted);

}  // namespace palpate::io::internal
