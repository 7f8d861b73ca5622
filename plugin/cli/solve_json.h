#pragma once

/// Force balances as JSON Lines: a line with a balance in, a line with its proxy and forces out. Meters, newtons and
/// newtons per meter, in the frame of the haptic device.
///
/// In:  {"id": any string or number, "stiffness": N/m, "probe": [m,m,m], "previous": [m,m,m], "primitives": [...]}, a
///      primitive being {"type": "force"|"plane"|"line"|"point", "strength": N|"inf", "position": [m,m,m],
///      "direction": [..]}. "id" may be missing, and "previous", which is then the probe; a force needs no position, a
///      point no direction. Other keys are not read.
/// Out: {"id", "proxy": [m,m,m], "force": [N,N,N], "forces": [[N,N,N],..], "solver", "error_bound": m, "iterations",
///      "time_ns"}, or {"id", "error": words that name the primitive and the field}. The id is null if none could be
///      read. Numbers read back as the same doubles. Where the cap on work was hit, "capped": true says so and the
///      error bound is that of the best answer found.

#include <cstddef>
#include <string>
#include <string_view>

#include "solver/solver_type.h"

namespace palpate::plugin {

struct SolveOptions {
  const solver::SolverType* solver = nullptr;  ///< null: the chain
  int repeat = 1;  ///< solves of each balance, without a warm start; time_ns is the fastest of them
};

struct SolvedLine {
  std::string json;  ///< one line, without its end
  bool solved = false;
};

/// Lines up to this long are read, in bytes: about 100 000 primitives.
inline constexpr std::size_t longest_line = std::size_t{16} << 20U;

/// Answers any bytes whatever; throws nothing.
SolvedLine solve_line(std::string_view line, const SolveOptions& options = {}) noexcept;

}  // namespace palpate::plugin
