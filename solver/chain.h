#pragma once

/// The priority chain of section 5: the first solver that can solve the balance does. A solver known not to be needed
/// can be switched off.

#include <cstddef>
#include <span>
#include <vector>

#include "palpate/solver/descent.h"
#include "palpate/solver/exact.h"
#include "palpate/solver/solution.h"

namespace palpate::solver {

struct ChainOptions {
  bool analytical = true;
  bool exact = true;     ///< solves every balance
  bool descent = false;  ///< the paper's numerical solver, kept as the reference
  DescentOptions descent_options;
  ExactOptions exact_options;
  bool warm_start = true;     ///< the exact solver starts from the forces of the previous balance, if that had as many
  std::size_t capacity = 64;  ///< primitives to reserve memory for
};

/// Holds what one frame hands to the next (the forces, as a start) and scratch memory: one for each thread.
class Chain {
 public:
  explicit Chain(const ChainOptions& options = {});

  /// forces: one for each primitive, in the order given; each primitive's force on the proxy, N. Does not allocate,
  /// lock, throw or log for balances of up to the number of primitives reserved.
  Solution solve(const Balance& balance, std::span<Vec3> forces) noexcept;

  /// The next balance starts cold.
  void forget() noexcept { last_forces_.clear(); }

 private:
  ChainOptions options_;
  ExactScratch scratch_;
  std::vector<Vec3> last_forces_;
};

}  // namespace palpate::solver
