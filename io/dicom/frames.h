#pragma once

/// Images that repeat at a position (time, b-value, echo, phase) are frames: volumes of their own.

#include <string>
#include <vector>

#include "io/dicom/series_source.h"

namespace palpate::io::internal {

struct FrameSplit {
  std::vector<std::vector<SeriesSource::Slice>> frames;  ///< slices of each, ascending along the normal
  std::vector<std::string> names;                        ///< what tells each from the others; one a frame
  /// Of each frame, the places (mm) where it has no slice although half of the frames or more have one.
  std::vector<std::vector<Vec3>> lacking;
  bool ranked = false;  ///< whether labels do not tell all of them apart, so that their order has to
  std::vector<SeriesSource::Slice> left_over;  ///< images at a place that another one has, without being a frame
};

/// A label's value in words, such as "b = 1000 s/mm2".
std::string label_text(Label label, const std::string& value);

/// Images of one orientation and size -> frames. Two images are at one position where they are closer along the normal
/// than 2 % of a pixel. Frames are told apart by the labels (b-value, echo, ...) that take the same few values all over
/// the stack, each of which tells more than those before it; where these do not tell, by order of acquisition. What
/// would make a frame of less than half of the slices is left over.
FrameSplit split_into_frames(const SeriesSource& source, std::vector<SeriesSource::Slice> slices);

}  // namespace palpate::io::internal
