#include "io/structures/smoothest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/for_processor.h"
#include "io/parallel.h"

namespace palpate::io {
namespace {

constexpr int edge = NodeBricks::edge;
constexpr std::size_t nodes = NodeBricks::nodes;
constexpr std::ptrdiff_t wide = edge + 2;
constexpr float no_node = std::numeric_limits<float>::quiet_NaN();

/// One lattice of the pyramid. A node that does not belong to it is NaN in all three.
struct Level {
  NodeBricks bricks;
  std::vector<float> lower, upper, f;
};

using Around = std::array<float, static_cast<std::size_t>(wide) * wide * wide>;

/// Weights of the second differences along the axes, so that the largest is 1.
struct Stencil {
  float x = 1, y = 1, z = 1;
};

Stencil stencil_of(const NodeLattice& lattice) {
  const Vec3& h = lattice.spacing;
  const double least = std::min({h.x, h.y, h.z});
  const Vec3 w = (Vec3(least) / h) * (Vec3(least) / h);
  return {static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)};
}

/// The weighted Laplacian of a brick's nodes from the numbers around; 0 where a neighbor is no node.
PALPATE_FOR_PROCESSOR
void laplacian(const float* around, const Stencil& w, float* into) {
  for (int k = 0; k < edge; ++k) {
    for (int j = 0; j < edge; ++j) {
      const float* c = around + ((k + 1) * wide + j + 1) * wide + 1;
      float* row = into + NodeBricks::at(0, j, k);
      for (int i = 0; i < edge; ++i) {
        const float twice = 2.0F * c[i];
        const float sum = w.x * (c[i - 1] + c[i + 1] - twice) + w.y * (c[i - wide] + c[i + wide] - twice) +
                          w.z * (c[i - wide * wide] + c[i + wide * wide] - twice);
        row[i] = sum == sum ? sum : 0.0F;
      }
    }
  }
}

/// For every brick, in stretches, on all threads.
template <typename Work>
void for_bricks(std::size_t count, int threads, const Work& work) {
  constexpr std::size_t stretch = 64;
  internal::parallel_for((count + stretch - 1) / stretch,
                         [&](std::size_t n) {
                           const std::size_t end = std::min(count, (n + 1) * stretch);
                           for (std::size_t slot = n * stretch; slot < end; ++slot) {
                             work(slot);
                           }
                         },
                         {}, threads);
}

/// Accelerated projected gradient steps on |Laplacian f|^2 within the bounds.
void descend(Level& level, int steps, int threads) {
  const std::size_t count = level.bricks.count();
  const Stencil w = stencil_of(level.bricks.lattice);
  const float most = 4.0F * (w.x + w.y + w.z);  // the largest eigenvalue of the Laplacian
  const float step = 1.0F / (most * most);
  std::vector<float> y = level.f;
  std::vector<float> curved(count * nodes);
  std::vector<double> against(count);
  double t = 1;
  for (int n = 0; n < steps; ++n) {
    for_bricks(count, threads, [&](std::size_t slot) {
      Around around;
      gather<1, float>(level.bricks, y, slot, no_node, around.data());
      laplacian(around.data(), w, curved.data() + slot * nodes);
    });
    const double next_t = 0.5 * (1 + std::sqrt(1 + 4 * t * t));
    const auto onward = static_cast<float>((t - 1) / next_t);
    for_bricks(count, threads, [&](std::size_t slot) {
      Around around;
      gather<1, float>(level.bricks, curved, slot, 0.0F, around.data());
      std::array<float, nodes> slope;
      laplacian(around.data(), w, slope.data());
      float* f = level.f.data() + slot * nodes;
      float* at = y.data() + slot * nodes;
      const float* lower = level.lower.data() + slot * nodes;
      const float* upper = level.upper.data() + slot * nodes;
      float turned = 0;
      for (std::size_t i = 0; i < nodes; ++i) {
        float next = at[i] - step * slope[i];
        next = next < lower[i] ? lower[i] : next;
        next = next > upper[i] ? upper[i] : next;
        const float moved = next - f[i];
        const float back = (at[i] - next) * moved;
        turned += back == back ? back : 0.0F;
        f[i] = next;
        at[i] = next + onward * moved;
      }
      against[slot] = static_cast<double>(turned);
    });
    t = next_t;
    // Where the steps overshoot, begin again from rest.
    double sum = 0;
    for (const double part : against) sum += part;
    if (sum > 0) {
      t = 1;
      y = level.f;
    }
  }
}

/// The lattice of every second node.
Level coarser(const Level& fine) {
  Level level;
  const NodeLattice& lattice = fine.bricks.lattice;
  level.bricks.lattice = lattice;
  level.bricks.lattice.spacing = lattice.spacing * 2.0;
  level.bricks.lattice.bricks = (lattice.bricks + 1) / 2;
  const glm::ivec3 size = level.bricks.lattice.bricks;
  level.bricks.slot.assign(
      static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z),
      NodeBricks::outside);
  for (std::size_t from = 0; from < fine.bricks.count(); ++from) {
    const glm::ivec3 place = fine.bricks.place[from] / 2;
    std::int32_t& slot = level.bricks.slot[(static_cast<std::size_t>(place.z) * static_cast<std::size_t>(size.y) +
                                            static_cast<std::size_t>(place.y)) *
                                               static_cast<std::size_t>(size.x) +
                                           static_cast<std::size_t>(place.x)];
    if (slot < 0) {
      slot = static_cast<std::int32_t>(level.bricks.count());
      level.bricks.place.push_back(place);
      for (auto* numbers : {&level.lower, &level.upper, &level.f}) {
        numbers->resize(numbers->size() + nodes, no_node);
      }
    }
    const glm::ivec3 part = (fine.bricks.place[from] - place * 2) * (edge / 2);
    for (int k = 0; k < edge / 2; ++k) {
      for (int j = 0; j < edge / 2; ++j) {
        for (int i = 0; i < edge / 2; ++i) {
          const std::size_t into =
              static_cast<std::size_t>(slot) * nodes + NodeBricks::at(part.x + i, part.y + j, part.z + k);
          const std::size_t of = from * nodes + NodeBricks::at(2 * i, 2 * j, 2 * k);
          level.lower[into] = fine.lower[of];
          level.upper[into] = fine.upper[of];
          level.f[into] = fine.f[of];
        }
      }
    }
  }
  return level;
}

/// Fills the nodes between those of the coarser lattice, within the bounds.
void refine(const Level& coarse, int threads, Level& fine) {
  for_bricks(fine.bricks.count(), threads, [&](std::size_t slot) {
    const glm::ivec3 place = fine.bricks.place[slot];
    const glm::ivec3 from = place / 2;
    const glm::ivec3 part = (place - from * 2) * (edge / 2);
    Around around;
    gather<1, float>(coarse.bricks, coarse.f, static_cast<std::size_t>(coarse.bricks.slot_at(from.x, from.y, from.z)),
                     no_node, around.data());
    for (int k = 0; k < edge; ++k) {
      for (int j = 0; j < edge; ++j) {
        for (int i = 0; i < edge; ++i) {
          float sum = 0;
          float weight = 0;
          for (int corner = 0; corner < 8; ++corner) {
            const int x = (i + ((corner & 1) != 0 ? 1 : 0)) / 2;
            const int y = (j + ((corner & 2) != 0 ? 1 : 0)) / 2;
            const int z = (k + ((corner & 4) != 0 ? 1 : 0)) / 2;
            const float f =
                around[static_cast<std::size_t>(((part.z + z + 1) * wide + part.y + y + 1) * wide + part.x + x + 1)];
            if (f == f) {
              sum += f;
              weight += 1;
            }
          }
          const std::size_t into = slot * nodes + NodeBricks::at(i, j, k);
          if (weight > 0) {
            fine.f[into] = std::clamp(sum / weight, fine.lower[into], fine.upper[into]);
          }
        }
      }
    }
  });
}

/// Half-way between what is inside and what is outside.
std::vector<float> first_guess(const DistanceBounds& bounds) {
  std::vector<float> f(bounds.lower.size());
  for (std::size_t n = 0; n < f.size(); ++n) {
    f[n] = 0.5F * (bounds.lower[n] + bounds.upper[n]);
  }
  return f;
}

}  // namespace

std::vector<float> smoothest(const DistanceBounds& bounds, const SmoothestOptions& options) {
  std::vector<Level> levels(1);
  levels[0] = {bounds.bricks, bounds.lower, bounds.upper, first_guess(bounds)};
  for (int n = 1; n < options.levels; ++n) {
    levels.push_back(coarser(levels.back()));
  }
  for (std::size_t n = levels.size(); n-- > 0;) {
    descend(levels[n], n == 0 ? options.fine_steps : options.coarse_steps, options.threads);
    if (n > 0) {
      refine(levels[n], options.threads, levels[n - 1]);
    }
  }
  return std::move(levels[0].f);
}

}  // namespace palpate::io
