#include "io/structures/coarser_bounds.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "io/structures/cubic.h"

namespace palpate::io {
namespace {

constexpr std::ptrdiff_t coarse_width = brick_edge + 4;
constexpr std::size_t coarse_count = static_cast<std::size_t>(coarse_width) * coarse_width * coarse_width;

/// Of the eight bricks that a coarser one is made of, the one to read where `part` is missing: the nearest there is.
int stand_in(const std::array<std::int32_t, 8>& from, int part) {
  int best = -1;
  for (int other = 0; other < 8; ++other) {
    const auto steps = [&](int one) { return std::popcount(static_cast<unsigned>(one ^ part)); };
    if (from[static_cast<std::size_t>(other)] >= 0 && (best < 0 || steps(other) < steps(best))) best = other;
  }
  return best;
}

}  // namespace

Coarser coarser(const DistanceBounds& fine, const std::vector<float>& f, float most_mm) {
  Coarser level;
  NodeBricks& bricks = level.bounds.bricks;
  bricks.lattice = fine.bricks.lattice;
  bricks.lattice.spacing *= 2.0;
  bricks.lattice.bricks = (fine.bricks.lattice.bricks + 1) / 2;
  const glm::ivec3 size = bricks.lattice.bricks;
  for (int brick = 0; brick < size.x * size.y * size.z; ++brick) {
    const glm::ivec3 place(brick % size.x, brick / size.x % size.y, brick / (size.x * size.y));
    std::array<std::int32_t, 8> from{};
    for (int part = 0; part < 8; ++part) {
      from[static_cast<std::size_t>(part)] =
          fine.bricks.slot_at(2 * place.x + part % 2, 2 * place.y + part / 2 % 2, 2 * place.z + part / 4);
    }
    if (*std::max_element(from.begin(), from.end()) < 0) {
      bricks.slot.push_back(from[0]);
      continue;
    }
    bricks.slot.push_back(static_cast<std::int32_t>(bricks.count()));
    bricks.place.push_back(place);
    for (int n = 0; n < static_cast<int>(brick_nodes); ++n) {
      const glm::ivec3 node =
          2 * glm::ivec3(n % brick_edge, n / brick_edge % brick_edge, n / (brick_edge * brick_edge));
      const glm::ivec3 part = node / brick_edge;
      const int own = part.x + 2 * part.y + 4 * part.z;
      const int read = stand_in(from, own);
      const glm::ivec3 first = brick_edge * glm::ivec3(read % 2, read / 2 % 2, read / 4);
      const glm::ivec3 in = glm::clamp(node - first, glm::ivec3(0), glm::ivec3(brick_edge - 1));
      const std::size_t of = static_cast<std::size_t>(from[static_cast<std::size_t>(read)]) * brick_nodes +
                             NodeBricks::at(in.x, in.y, in.z);
      level.bounds.lower.push_back(read == own ? fine.lower[of] : -most_mm);
      level.bounds.upper.push_back(read == own ? fine.upper[of] : most_mm);
      level.f.push_back(f[of]);
    }
  }
  return level;
}

void refine(const NodeBricks& coarse, const std::vector<float>& numbers, const NodeBricks& fine,
            std::vector<float>& into) {
  for (std::size_t slot = 0; slot < fine.count(); ++slot) {
    const glm::ivec3 place = fine.place[slot];
    const glm::ivec3 from = place / 2;
    const glm::ivec3 first = (place - from * 2) * (brick_edge / 2) + 2;
    std::array<float, coarse_count> around;
    gather<2, float>(coarse, numbers, static_cast<std::size_t>(coarse.slot_at(from.x, from.y, from.z)), no_node,
                     around.data());
    for (int n = 0; n < static_cast<int>(brick_nodes); ++n) {
      const glm::ivec3 node(n % brick_edge, n / brick_edge % brick_edge, n / (brick_edge * brick_edge));
      const glm::ivec3 cell = first + node / 2 - 1;
      const glm::dvec3 t = 0.5 * glm::dvec3(node - node / 2 * 2);
      const CubicSample sample = cubic_sample(around.data() + (cell.z * coarse_width + cell.y) * coarse_width + cell.x,
                                              coarse_width, coarse_width * coarse_width, t);
      if (std::isfinite(sample.value))
        into[slot * brick_nodes + static_cast<std::size_t>(n)] = static_cast<float>(sample.value);
    }
  }
}

}  // namespace palpate::io
