#pragma once

/// The exact solver: any finite set of primitives, co-located or not, orthogonal or not, hard or not.
///
/// The proxy minimizes a strongly convex energy of three unknowns, E(x) = k/2 |x - probe|^2 + sum phi_i(x). E is smooth
/// except on the planes, lines and points of the primitives. So the proxy lies on a flat (all of space, a plane, a line
/// or a point) on which some primitives hold it, and is the minimum of a smooth function there. The solver walks down E
/// from flat to flat:
///
/// * On a flat it takes Newton's steps, each shortened to the point where E is least. A plane that the step crosses is
///   locked if it pushes back from both sides. A line or point that the step passes is locked if E is lower on it. The
///   flat loses a dimension with each lock.
/// * At the minimum on a flat, the force needed is shared among the locked primitives. If each can exert its share, the
///   proxy is found. Otherwise the primitive that lacks the most force is released, and the walk goes on.
///
/// The walk ends: every step lowers E, and the minimum of a flat is reached before it is left. So no flat is left
/// twice, and there are finitely many flats. If rounding prevents this, the cap on work ends the walk: Outcome::capped,
/// with the best answer found and its true bound. If more primitives meet than are needed to fix a point, as at the old
/// proxy, the nearest point of the sum of their force bodies gives their shares (exact/share.h). If the shares do not
/// decide which to release, the primitives are moved apart by less than half an ulp, each in its own direction, and the
/// walk is done again. Distances to near primitives are computed in double-double, relative to the probe, so that
/// primitives parallel to within an ulp are told apart.
///
/// A hard constraint is given a very large strength, which is raised until all hard constraints are met: an exact
/// penalty (D. P. Bertsekas, Constrained Optimization and Lagrange Multiplier Methods, 1982, 4.3).

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "solver/solver_type.h"

namespace palpate::solver {

/// Memory for balances of up to `capacity` primitives; a larger balance makes it grow, which allocates.
class ExactScratch final : public Scratch {
 public:
  explicit ExactScratch(std::size_t capacity = 64);
  ~ExactScratch() override;
  ExactScratch(ExactScratch&&) noexcept;
  ExactScratch& operator=(ExactScratch&&) noexcept;

  std::size_t memory_bytes() const noexcept override;

  struct Arrays;
  Arrays& arrays() { return *arrays_; }

 private:
  std::unique_ptr<Arrays> arrays_;
};

/// forces: one for each primitive; out: its force on the proxy, N. If constraints are redundant, these are one of many
/// possible sets; the proxy is unique.
///
/// error_bound is certify()'s law, evaluated in double-double where the answer was found. Outcome::solved means: within
/// promised_accuracy(), or as exact as data within 4 ulp allow (the bound may then be looser, and is still true).
/// Outcome::refused means: the hard constraints have no common point, Flaw::incompatible. The balance must be one that
/// validate() accepts. No allocation within the scratch's capacity. max_iterations: passes over all primitives, O(n)
/// each, in the longest walk; 400 by default.
Solution solve_exact(const Balance& balance, std::span<Vec3> forces, ExactScratch& scratch,
                     const RunOptions& options = {}) noexcept;

extern const SolverType exact_solver;

}  // namespace palpate::solver
