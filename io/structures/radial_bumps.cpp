#include "io/structures/radial_bumps.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "io/for_processor.h"

namespace palpate::io::internal {
namespace {

/// All lengths in parts of the reach. `first`: from the bump to the brick's first node; `step`: to the next node.
PALPATE_FOR_PROCESSOR
void add_bump(const Vec3& first, const Vec3& step, double weight, double* sums) {
  const double start = first.x, along_step = step.x;
  for (int k = 0; k < brick_edge; ++k) {
    const double z = first.z + k * step.z;
    for (int j = 0; j < brick_edge; ++j) {
      const double y = first.y + j * step.y, aside = y * y + z * z;
      if (aside >= 1) continue;
      double* __restrict const into = sums + NodeBricks::at(0, j, k);
      PALPATE_INDEPENDENT
      for (int i = 0; i < brick_edge; ++i) {
        const double along = start + i * along_step;
        const double r = std::sqrt(std::min(aside + along * along, 1.0));
        const double in = (1 - r) * (1 - r);
        into[i] += weight * (in * in * (4 * r + 1));
      }
    }
  }
}

}  // namespace

double wendland(double r) noexcept {
  if (r >= 1) return 0;
  const double in = (1 - r) * (1 - r);
  return in * in * (4 * r + 1);
}

double sum_of(const RadialBumps& bumps, std::span<const std::uint32_t> which, const Vec3& place) noexcept {
  double sum = 0;
  for (const std::uint32_t n : which) {
    const Vec3 away = place - bumps.at[n];
    const double squared = glm::dot(away, away);
    if (squared >= bumps.reach_mm * bumps.reach_mm) continue;
    sum += bumps.weight[n] * wendland(std::sqrt(squared) / bumps.reach_mm);
  }
  return sum;
}

void add_at_nodes(const RadialBumps& bumps, std::span<const std::uint32_t> which, const NodeLattice& lattice,
                  const glm::ivec3& brick, std::span<double, brick_nodes> sums) noexcept {
  const Vec3 corner = lattice.position(Vec3(brick * brick_edge));
  const Vec3 step = lattice.spacing / bumps.reach_mm;
  for (const std::uint32_t n : which) {
    // From the bump to the brick's first node, along the lattice's axes.
    const Vec3 first = (glm::transpose(lattice.axes) * (corner - bumps.at[n])) / bumps.reach_mm;
    add_bump(first, step, bumps.weight[n], sums.data());
  }
}

}  // namespace palpate::io::internal
