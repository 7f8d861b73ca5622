#pragma once

/// Slices in order and the geometry that follows from their positions alone.

#include <span>
#include <string>
#include <vector>

#include "io/dicom/file_header.h"
#include "solver/text/message.h"

namespace palpate::io::internal {

/// With two decimals and the unit, in every locale.
std::string millimeters(double value);

/// How far an image lies along direction_i x direction_j of `reference`, mm.
double height_of(const Vec3& position, const Placement& reference);

/// What is closer along the normal lies at one position: 2 % of a pixel, mm.
double same_place_mm(const Placement& reference);

/// Geometry of parallel slices. `positions` ascend along the normal; `lost` are positions where a slice is known to
/// exist that cannot be read. `thickness` (mm) is the step of a single slice.
///
/// Uniform where every step is within 2 % of the mean one. A gap is an interval that holds a lost position, or is more
/// than 1.5 times the median one without being part of an evenly spaced run of three or more such intervals, which is
/// how a protocol with two slice distances looks.
Geometry stack_geometry(int columns, int rows, const Placement& reference, std::vector<Vec3> positions,
                        std::span<const Vec3> lost, double thickness);

/// What a user should know of it: missing slices with their place, uneven steps. One sentence each; may be empty.
/// `thickness` (mm, 0 where unknown) is that of a slice: where neighbors overlap by half of it, that is said.
std::vector<Text> geometry_warnings(const Geometry& geometry, double thickness);

}  // namespace palpate::io::internal
