#pragma once

/// The tables and the picture of `palpate-bench forces`.

#include <filesystem>
#include <span>
#include <string>

#include "plugin/bench/force_study.h"
#include "plugin/report/chart.h"

namespace palpate::plugin {

/// A line for each row. Without times it depends only on the seed and the paths.
std::string forces_csv(std::span<const ForceRowResult> results, std::uint64_t seed, bool with_times);
/// A line for each row and boundary: how often the true boundary is within the stated uncertainty.
std::string known_csv(std::span<const ForceRowResult> results, std::uint64_t seed);
/// A line for each pair of boundaries, the one that pushes in the truth and the one in a row: their part of the sum of
/// squares.
std::string pairs_csv(std::span<const ForceRowResult> results, std::uint64_t seed);

void print_forces(std::span<const ForceRowResult> results);
void print_known(std::span<const ForceRowResult> results);
/// The pairs with most of the error, for the rows of one group.
void print_pairs(std::span<const ForceRowResult> results, const std::string& group);

/// RMS of the force error against the time of a tick; each row is a point.
Chart error_against_time(std::span<const ForceRowResult> results);

}  // namespace palpate::plugin
