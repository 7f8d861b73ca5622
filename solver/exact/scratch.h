#pragma once

/// The memory of the exact solver.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "solver/exact.h"
#include "solver/exact/placed.h"
#include "solver/exact/sorted.h"
#include "solver/exact/walk.h"

namespace palpate::solver {

struct ExactScratch::Arrays {
  std::vector<internal::Placed> placed;
  std::vector<internal::Placed> moved;
  std::vector<Vec3> forces;
  std::vector<internal::ForceRegion> hold;
  std::vector<std::uint32_t> met;
  internal::Sorted sorted;    // of many primitives
  internal::Columns columns;  // of the same

  void fit(std::size_t n) {
    if (placed.size() < n) {
      placed.resize(n);
      moved.resize(n);
      forces.resize(n);
      hold.resize(n);
      met.resize(n);
      if (n > internal::most_unsorted) {
        sorted.fit(n);
        columns.fit(n);
      }
    }
  }
};

}  // namespace palpate::solver
