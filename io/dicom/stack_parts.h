#pragma once

/// Interleaved stacks: two acquisitions offset by half a slice are two volumes, not one with twice as many slices.

#include <string>
#include <vector>

#include "io/dicom/series_source.h"
#include "solver/text/message.h"

namespace palpate::io::internal {

struct StackPart {
  std::vector<SeriesSource::Slice> slices;
  std::string name;  ///< distinguishes it from the others, such as "acquisition 2"; empty if there is only one part
  /// Parts with the same number are frames of one volume: they have equally many slices, each less than a quarter of a
  /// step from those of the others (a scanner that follows head motion). Other parts are separate volumes.
  int volume = 0;
};

struct PartedStack {
  std::vector<StackPart> parts;
  std::vector<Text> doubts;  ///< for the user to check, if the headers leave a doubt
};

/// Splits images of one orientation and size (at least one) into stacks. Images with different labels (side of the
/// body, place in the plane, file, kind of image, kernel, echo, b-value, time, acquisition, order of times or numbers)
/// are separate parts if each is an evenly spaced stack by itself, and their extents overlap but their slices do not.
///
/// Some labels may also number the passes of one interleaved acquisition (acquisition, trigger time, times and order).
/// They separate parts only if the images cannot be such passes: if neighbors overlap by their SliceThickness, or the
/// combined steps are uneven. In MR, times and numbers never split an evenly spaced stack, even if its slices overlap,
/// because within one scan they can be equal or run backwards. Stacks that follow each other are one stack.
PartedStack part_stack(const SeriesSource& source, std::vector<SeriesSource::Slice> slices);

}  // namespace palpate::io::internal
