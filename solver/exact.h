#pragma once

/// The exact solver: any finite set of primitives, co-located or not, orthogonal or not, hard or not.
///
/// The proxy minimises a strongly convex energy of three unknowns, E(x) = k/2 |x - probe|^2 + sum phi_i(x). Each phi_i
/// is the support function of a convex force body. The method of multipliers (D. P. Bertsekas, Constrained Optimization
/// and Lagrange Multiplier Methods, 1982, ch. 5) replaces phi_i by its Moreau envelope of stiffness sigma about the
/// current force F_i: what is to be minimised then has a continuous, piecewise smooth gradient, and a semismooth Newton
/// method (L. Qi, J. Sun, 1993) with a line search along that gradient finds its minimum in a few steps of O(n) and one
/// 3 x 3 system. Its forces are the next F_i. Every round shrinks the error by about k / sigma.
///
/// As soon as the forces tell which primitives hold the proxy (those strictly inside their force bodies), the proxy is
/// put onto their flat in double-double arithmetic, and the smooth rest, of dimension 3 - rank, is solved by Newton's
/// method. That answer counts only with its certificate; otherwise sigma rises and the next round begins.
///
/// It ends because each round has a unique minimum that the line search approaches monotonically, because the rounds
/// are the proximal point method on a concave dual that has a maximum (R. T. Rockafellar, 1976), and in any case at the
/// cap on Newton steps: Outcome::capped, with the best answer found and its true bound.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "palpate/solver/solution.h"

namespace palpate::solver {

struct ExactOptions {
  int max_iterations = 200;  ///< Newton steps, of O(n) each
};

enum class Start : std::uint8_t {
  cold,  ///< the forces given are not read
  warm   ///< from the forces given (N), for example those of the previous frame; any finite numbers will do
};

/// Memory for balances of up to `capacity` primitives; a larger balance makes it grow, which allocates.
class ExactScratch {
 public:
  explicit ExactScratch(std::size_t capacity = 64);
  ~ExactScratch();
  ExactScratch(ExactScratch&&) noexcept;
  ExactScratch& operator=(ExactScratch&&) noexcept;

  struct Arrays;
  Arrays& arrays() { return *arrays_; }

 private:
  std::unique_ptr<Arrays> arrays_;
};

/// forces: as many as primitives; out: each primitive's force on the proxy, N. Where the constraints are redundant
/// these are one of many possible sets; the proxy is unique.
///
/// error_bound is certify()'s law, evaluated in double-double where the answer was found. Solved: within
/// promised_accuracy(), or as exact as data within 4 ulp allow (then the bound may be looser, and is still true).
/// Refused: hard constraints without a common point, Flaw::incompatible. The balance has to be one that validate()
/// accepts. No allocation within the scratch's capacity.
Solution solve_exact(const Balance& balance, std::span<Vec3> forces, ExactScratch& scratch, Start start = Start::cold,
                     const ExactOptions& options = {}) noexcept;

}  // namespace palpate::solver
