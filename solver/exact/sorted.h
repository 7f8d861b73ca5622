#pragma once

/// The primitives of a balance sorted by kind, so that the processor predicts the branches of a pass over many of them.

#include <cstdint>
#include <span>
#include <vector>

#include "solver/balance.h"
#include "solver/solution.h"

namespace palpate::solver::internal {

class Sorted {
 public:
  void fit(std::size_t n);
  std::size_t memory_bytes() const noexcept;

  /// The same balance and forces, sorted. Valid until the next call.
  Balance take(const Balance& balance, std::span<const Vec3> forces);
  std::span<Vec3> forces() { return std::span(forces_).first(count_); }
  /// Puts the sorted forces and the solution's index of a primitive back into the order of the balance.
  void give_back(std::span<Vec3> forces, Solution& solution) const;

 private:
  std::size_t count_ = 0;
  std::vector<Primitive> primitives_;
  std::vector<Vec3> forces_;
  std::vector<std::uint32_t> order_;
};

}  // namespace palpate::solver::internal
