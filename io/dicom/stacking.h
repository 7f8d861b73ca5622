#pragma once

/// Slices in order, and the geometry that follows from their positions alone.

#include <span>
#include <string>
#include <vector>

#include "io/dicom/file_header.h"
#include "solver/text/message.h"

namespace palpate::io::internal {

/// A length with two decimals and the unit, in every locale.
std::string millimeters(double value);

/// The height of an image along direction_i x direction_j of `reference`, mm.
double height_of(const Vec3& position, const Placement& reference);

/// Images closer along the normal than this are at one position: 2 % of a pixel, mm.
double same_place_mm(const Placement& reference);

/// Geometry of parallel slices. `positions` ascend along the normal; `lost` holds the positions of slices that exist
/// but cannot be read. `thickness` (mm) is the step if there is only one slice.
///
/// Uniform if every step is within 2 % of the mean. A gap is an interval that holds a lost position, or one longer than
/// 1.5 times the median. A run of three or more equal long intervals is not a gap: a protocol may have two slice
/// distances.
Geometry stack_geometry(int columns, int rows, const Placement& reference, std::vector<Vec3> positions,
                        std::span<const Vec3> lost, double thickness);

/// Warnings for the user: missing slices with their positions, uneven steps. One sentence each; may be empty.
/// `thickness` (mm, 0 if unknown) is that of a slice: neighbors that overlap by half of it are reported.
std::vector<Text> geometry_warnings(const Geometry& geometry, double thickness);

}  // namespace palpate::io::internal
