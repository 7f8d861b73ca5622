#pragma once

/// The first-order sums of moments.h for large blocks of a scan whose slices are displaced within their planes (a
/// tilted gantry): plain loops along a row, as in straight_sums.h. Each voxel's sum is taken in the order of moments.h,
/// so it has the same bits. Sums of one voxel are tile_width floats apart.

#include <glm/vec3.hpp>

#include "io/fields/slice_kernel.h"

namespace palpate::io::internal {

/// `in` points at the first voxel's value, with valid values before and after as far as the taps reach. Writes rows
/// one, p.
void sum_tilted_row(const float* in, const Taps& taps, int width, float* sums);

/// Three sums in a plane (rows one, p, q) from rows of sums that are 2 * tile_width floats apart; `rows` points at the
/// sums of the current row.
void sum_tilted_column(const float* rows, const Taps& taps, int width, float* sums);

/// Shifts a slice's in-plane sums to the origin of the current slice, and adds them to rows one, p, q, w.
void add_tilted(const float* plane, const Contribution& slice, int width, float* sums);

/// Gradients of the voxels from `begin` to `end` of a row from these sums, each with its own fit: rows as in
/// straight_sums.h.
void fit_sums(const float* sums, const float* fits, int begin, int end, glm::vec3* gradients);

}  // namespace palpate::io::internal
