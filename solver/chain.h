#pragma once

/// The priority chain of section 5: the solvers are tried in order, and the first that can solve the balance answers. A
/// solver that is not needed can be switched off. If only the analytical one is left and its bound misses the promise
/// by at most 1e-9 m, its answer is returned as Outcome::capped, with its true bound.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "solver/solver_type.h"

namespace palpate::solver {

struct ChainOptions {
  SolverSet solvers = SolverSet::usual();
  bool warm_start = true;     ///< from the previous balance's forces, if the number of primitives is the same
  int max_iterations = 0;     ///< of each solver; 0: the solver's default
  std::size_t capacity = 64;  ///< primitives to reserve memory for
};

/// Keeps the forces of the previous tick, as a start for the next one, and scratch memory. One for each thread.
class Chain {
 public:
  explicit Chain(const ChainOptions& options = {});

  /// forces: one for each primitive, in the order given; each primitive's force on the proxy, N. Does not allocate,
  /// lock, throw or log for balances of up to the number of primitives reserved.
  ///
  /// The same balance twice in a row returns the same answer, so that the force on a resting stylus is constant to the
  /// last bit in spite of the warm start. The previous proxy is not compared, unless the solver that answered reads it.
  Solution solve(const Balance& balance, std::span<Vec3> forces) noexcept;

  /// Bytes on the heap, with those of each solver that is switched on.
  std::size_t memory_bytes() const noexcept;

  /// The next balance starts without the forces of the previous one.
  void forget() noexcept;

 private:
  struct Member {
    const SolverType* type;
    std::unique_ptr<Scratch> scratch;
  };

  Solution solve_in_order(const Balance& balance, std::span<Vec3> forces) const noexcept;
  bool is_last(const Balance& balance) const noexcept;
  void remember(const Balance& balance, const Solution& solution, std::span<const Vec3> forces) noexcept;

  ChainOptions options_;
  std::vector<Member> members_;
  std::vector<Vec3> last_forces_;
  std::vector<Primitive> last_primitives_;
  Balance last_;  ///< its primitives are those above
  Solution last_solution_;
};

}  // namespace palpate::solver
