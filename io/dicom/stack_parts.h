#pragma once

/// Stacks that lie in one another: two acquisitions offset by half a slice are two volumes, not one of twice as many.

#include <string>
#include <vector>

#include "io/dicom/series_source.h"
#include "solver/text/message.h"

namespace palpate::io::internal {

struct StackPart {
  std::vector<SeriesSource::Slice> slices;
  std::string name;  ///< what tells it from the others, such as "acquisition 2"; empty where there is but one part
  /// Parts of one volume are frames of it: they hold as many slices, each less than a quarter of a step from the
  /// others' (a scanner that follows a head's motion). All others are volumes of their own.
  int volume = 0;
};

struct PartedStack {
  std::vector<StackPart> parts;
  std::vector<Text> doubts;  ///< what a user should check, where the headers do not decide it
};

/// Images of one orientation and size, at least one -> the stacks they make up. Images that a label tells apart (side
/// of the body, place in the plane, file, kind of image, kernel, echo, b-value, time, acquisition, order of times or
/// numbers) are parts where each of them is an even stack by itself and their extents overlap, but not their slices.
///
/// A label that may also number the passes of one interleaved acquisition (acquisition, trigger time, times and order)
/// makes parts only of what cannot be such passes: of neighbors that overlap by their SliceThickness, and of steps that
/// are uneven when taken together. Times and numbers make no parts of an even stack of MR even if its slices overlap:
/// they tie, and turn back, within one scan. Stacks that follow each other are one.
PartedStack part_stack(const SeriesSource& source, std::vector<SeriesSource::Slice> slices);

}  // namespace palpate::io::internal
