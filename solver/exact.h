#pragma once

/// The exact solver: any finite set of primitives, co-located or not, orthogonal or not, hard or not.
///
/// The proxy minimises a strongly convex energy of three unknowns, E(x) = k/2 |x - probe|^2 + sum phi_i(x), smooth but
/// for the primitives themselves. So it lies on a flat (all of space, a plane, a line or a point) where some primitives
/// hold it, and is there the minimum of a smooth function. The solver walks down E from flat to flat:
///
/// * on a flat, Newton's steps, cut back to where E is least along them. A plane that is crossed on the way and pushes
///   back from both sides is locked, an attractor that is passed and lies deeper too: the flat loses a dimension;
/// * at the minimum on a flat, the force needed is shared among what is locked. Where each can exert its share that is
///   the proxy. Otherwise the one that can do it least is let go, and the walk goes on.
///
/// It ends: every step lowers E, every flat's minimum is reached before the flat is left, so no flat is left twice, and
/// there are finitely many. (In rounding: at the cap on work, Outcome::capped, with the best answer found and its true
/// bound.) Where more primitives meet than fix a point, as they do at the old proxy, they share the force as the
/// nearest point of the sum of their force bodies (internal/share.h); if that does not tell, they are moved apart by
/// less than half an ulp, each its own way, and the walk is done again. Distances to what is near are in double-double,
/// in coordinates relative to the probe, so primitives parallel to within an ulp are still told apart.
///
/// A hard constraint counts as one of a very large strength, which is raised until all of them are met: an exact
/// penalty (D. P. Bertsekas, Constrained Optimization and Lagrange Multiplier Methods, 1982, 4.3).

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "solver/solution.h"

namespace palpate::solver {

struct ExactOptions {
  int max_iterations = 400;  ///< looks at all primitives, of O(n) each, in the one walk that is long where any is
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

  std::size_t memory_bytes() const noexcept;  ///< what it holds beyond itself

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
