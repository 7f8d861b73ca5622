#pragma once

/// Images that repeat at a position (time, b-value, echo, phase) belong to different frames: separate volumes.

#include <string>
#include <vector>

#include "io/dicom/series_source.h"

namespace palpate::io::internal {

struct FrameSplit {
  std::vector<std::vector<SeriesSource::Slice>> frames;  ///< slices of each, ascending along the normal
  std::vector<std::string> names;                        ///< how each frame differs from the others
  /// For each frame, the positions (mm) where it has no slice although at least half of the frames have one.
  std::vector<std::vector<Vec3>> lacking;
  bool ranked = false;  ///< whether frames have the same labels, so that only their order distinguishes them
  std::vector<SeriesSource::Slice> left_over;  ///< images that repeat at a position but belong to no frame
};

/// A label's value in words, such as "b = 1000 s/mm2".
std::string label_text(Label label, const std::string& value);

/// Sorts images of one orientation and size into frames. Two images are at one position if their distance along the
/// normal is less than 2 % of a pixel. Labels (b-value, echo, ...) distinguish frames if they have the same few values
/// all over the stack. A label is used only if it distinguishes more images than the labels before it. Images with the
/// same labels are ordered by acquisition. A group with at most half as many slices as the largest frame is left over.
FrameSplit split_into_frames(const SeriesSource& source, std::vector<SeriesSource::Slice> slices);

}  // namespace palpate::io::internal
