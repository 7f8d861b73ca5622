#pragma once

/// Slices of a frame -> their places in a volume.

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "io/dicom/series_source.h"
#include "io/volume.h"

namespace palpate::io::internal {

using Slices = std::vector<SeriesSource::Slice>;

/// What is to be read: the rescaled values of a frame, or the velocities (m/s) that they stand for.
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

/// Padding of a volume of floats: far below any value, so that one range holds for slices of any rescale.
constexpr float float_padding = std::numeric_limits<float>::lowest();

/// Slices that come from one file, in the order of its frames, as indices into the reading's slices: the file is opened
/// once and a mosaic is decoded once. At most 16 frames, so that all cores share a multi-frame file; all
/// of a deflated one, which can only be inflated from its start.
using SliceUnit = std::vector<std::size_t>;
std::vector<SliceUnit> slice_units(const Reading& reading);

/// Reads a unit's slices to their places in `voxels`, which hold all of the reading's: as stored where they are of 16
/// bits, rescaled where they are floats. Calls failed(k, reason) for those that cannot be read, and noted(what) where
/// pixels were read that are not coded as they should be.
void read_unit(const Reading& reading, const SliceUnit& unit, Volume::Voxels& voxels,
               const std::function<void(std::size_t, const char*)>& failed,
               const std::function<void(const Text&)>& noted);

}  // namespace palpate::io::internal
