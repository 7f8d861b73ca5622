#pragma once

/// What is said of structures: segmentations, contours, label maps.

#include "messages/message.h"

namespace palpate::io::messages {

inline constexpr MessageRow structures[] = {
    {"as it goes on",
     "as it goes on",
     {{"structure-cannot-be-read", "{} cannot be read: {}"}, {"structure-cannot-be-felt", "{} cannot be felt: {}"}}},
    {"nobody outlined it",
     "choose another",
     {{"no-voxel-inside", "it is empty: no voxel is inside"},
      {"no-contour", "it is empty: it has no contour"},
      {"contours-have-no-area", "its contours have no area"}}},
    {"points and open lines have no inside",
     "close them where they were drawn",
     {{"no-closed-contour", "it has no closed contour, only {}"},
      {"contours-that-are-not-closed-are-left", "contours that are not closed are left out: {}"}}},
    {"damaged",
     "export it again",
     {{"contour-of-it-has-numbers", "a contour of it has {} numbers, not three a point"}}},
    {"contours of another kind, or damaged",
     "as it says",
     {{"contours-do-not-lie-in-parallel", "its contours do not lie in parallel planes: export it as SEG"},
      {"contours-lie-in-planes", "its contours lie in {} planes; there may be 4096"},
      {"contours-span-mm", "its contours span {} mm: more than can be felt"}}},
    {"it was not written whole",
     "as it says",
     {{"names-no-roi", "it names no ROI (StructureSetROISequence): export it again"},
      {"names-no-segments", "it names no segments (SegmentSequence): export it again"},
      {"frames-without-a-position", "it says of {} of its {} frames where they lie: export it again"},
      {"does-not-say-where-its-frames",
       "it does not say where its frames lie (PerFrameFunctionalGroupsSequence): export it again"},
      {"frame-without-a-position",
       "a frame of it does not say where it lies in the patient (position, orientation or spacing): export it again"},
      {"frame-without-a-segment", "a frame of it does not say to which segment it belongs: export it again"},
      {"no-pixels-export", "it has no pixels: export it again"},
      {"no-pixels-rows", "it has no pixels: Rows or Columns is missing"},
      {"maximumfractionalvalue-is-not-above-0", "its MaximumFractionalValue is not above 0: export it again"}}},
    {"a kind that is not read",
     "export it again as one that is",
     {{"pixels-have-bits", "its pixels have {} bits: a segmentation has 1, 8 or 16"},
      {"segmentation-type-is-unknown",
       "its segmentation type \"{}\" is unknown; there are: BINARY, FRACTIONAL, LABELMAP"}}},
    {"frames that are no one lattice",
     "as it says",
     {{"frames-have-several-orientations-or-pixel",
       "its frames have several orientations or pixel sizes: export each as a segmentation of its own"}}},
    {"as it says",
     "as it says",
     {{"outlines-a-microscope-slide", "it outlines a microscope's slide, not a scan: it cannot be felt"},
      {"holds-surfaces", "it holds surfaces (Surface Segmentation), which are not read: export it as SEG"}}},
};

}  // namespace palpate::io::messages
