#pragma once

/// Where the frames of a DICOM segmentation lie.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/dicom/stacking.h"
#include "io/structures/segment_frames.h"

class DcmItem;

namespace palpate::io {

struct PlacedFrame {
  int segment = 0;
  std::string stack;            ///< StackID
  std::optional<int> in_stack;  ///< InStackPositionNumber, in that stack
  internal::Placement placement;
  double spacing = 0;    ///< SpacingBetweenSlices, mm; 0 if it is not given
  double thickness = 0;  ///< SliceThickness, mm; 0 if it is not given
};

/// The places of the first `count` frames. Throws DicomError if one has no position, or names no segment although it
/// must.
std::vector<PlacedFrame> placed_frames(DcmItem& dataset, SegmentationType type, std::size_t count);

/// Whether two frames lie on parallel planes with the same pixels.
bool share_lattice(const internal::Placement& a, const internal::Placement& b);

/// The slices that frames lie on, ascending.
struct FrameSlices {
  std::vector<Vec3> position;
  std::vector<double> height;                    // along the normal, mm
  std::vector<std::vector<std::size_t>> frames;  // of each
};

/// Frames nearly at one height are on one slice. Throws DicomError if they lie beside each other there.
FrameSlices slices_of(const std::vector<PlacedFrame>& frames, const Vec3& normal);

/// How many steps of the lattice lie from each slice with a frame to the next, because a file may leave out empty
/// slices. If the frames give no spacing but their slices are numbered, the numbers decide. Otherwise all distances
/// have to be multiples of the least one (the spacing counts as one of them). All steps are 1 if nothing fits.
std::vector<int> steps_between(const FrameSlices& slices, const std::vector<PlacedFrame>& frames);

}  // namespace palpate::io
