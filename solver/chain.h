#pragma once

/// The priority chain of section 5: the first solver that can solve the balance does. A solver known not to be needed
/// can be switched off.

#include <span>

#include "palpate/solver/descent.h"
#include "palpate/solver/solution.h"

namespace palpate::solver {

struct ChainOptions {
  bool analytical = true;
  bool exact = true;     ///< solves every balance
  bool descent = false;  ///< the paper's numerical solver, kept as the reference
  DescentOptions descent_options;
};

class Chain {
 public:
  explicit Chain(const ChainOptions& options = {});

  /// forces: one for each primitive, in the order given; each primitive's force on the proxy, N. Does not allocate,
  /// lock, throw or log for balances of up to the number of primitives reserved.
  Solution solve(const Balance& balance, std::span<Vec3> forces) noexcept;

 private:
  ChainOptions options_;
};

}  // namespace palpate::solver
