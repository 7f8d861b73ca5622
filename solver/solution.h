#pragma once

/// What every solver returns.

#include <cstdint>
#include <optional>

#include "solver/balance.h"

namespace palpate::solver {

struct SolverType;

enum class Outcome : std::uint8_t {
  solved,      ///< proxy, forces and error bound are the answer
  capped,      ///< the cap on work was hit: the best answer so far, with its true bound
  unsuitable,  ///< this solver cannot solve this configuration; proxy and forces are not to be used
  refused      ///< the balance is flawed: see rejection; proxy and forces are not to be used
};

struct Solution {
  Outcome outcome = Outcome::unsuitable;
  const SolverType* solver = nullptr;  ///< the solver that found it; null if none did
  int iterations = 0;
  Vec3 proxy{0};           ///< m
  double error_bound = 0;  ///< m: |proxy - exact proxy| is at most this
  std::optional<Rejection> rejection;
};

}  // namespace palpate::solver
