#include "io/structures/smoothest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>

#include "io/for_processor.h"
#include "io/parallel.h"
#include "io/structures/closest_points.h"
#include "io/structures/coarser_bounds.h"

namespace palpate::io {
namespace {

constexpr std::ptrdiff_t bent_width = brick_edge + 4;
constexpr std::size_t bent_count = static_cast<std::size_t>(bent_width) * bent_width * bent_width;
constexpr float least_mm = 0.01F;
constexpr float unsaid = 1e3F;  // mm: farther than any distance in the band

using BentNodes = std::array<float, bent_count>;

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

/// The weighted Laplacian at a node.
inline float laplacian(const float* c, const Stencil& w) {
  constexpr std::ptrdiff_t plane = bent_width * bent_width;
  return -2.0F * (w.x + w.y + w.z) * c[0] + w.x * (c[-1] + c[1]) + w.y * (c[-bent_width] + c[bent_width]) +
         w.z * (c[-plane] + c[plane]);
}

/// The rows of a brick that hold nodes which are free: no others change. Both ends included.
struct Rows {
  int low_j = 0, high_j = brick_edge - 1, low_k = 0, high_k = brick_edge - 1;
};

/// The weighted Laplacian of the Laplacian of a brick's nodes, from the numbers around them. Rows run on into each
/// other: what that spoils is not read.
PALPATE_FOR_PROCESSOR
void bilaplacian(const float* around, const Stencil& w, const Rows& rows, float* into) {
  constexpr std::ptrdiff_t plane = bent_width * bent_width;
  const std::ptrdiff_t first = (rows.low_k + 1) * plane + (rows.low_j + 1) * bent_width + 1;
  const std::ptrdiff_t last = (rows.high_k + 3) * plane + (rows.high_j + 4) * bent_width - 1;
  std::array<float, bent_count> curved;
  const float middle = -2.0F * (w.x + w.y + w.z);
  float* out = curved.data();
  PALPATE_INDEPENDENT
  for (std::ptrdiff_t n = first; n < last; ++n) {
    const float* c = around + n;
    out[n] =
        middle * c[0] + w.x * (c[-1] + c[1]) + w.y * (c[-bent_width] + c[bent_width]) + w.z * (c[-plane] + c[plane]);
  }
  for (int k = rows.low_k; k <= rows.high_k; ++k) {
    for (int j = rows.low_j; j <= rows.high_j; ++j) {
      const float* c = curved.data() + ((k + 2) * bent_width + j + 2) * bent_width + 2;
      float* row = into + NodeBricks::at(0, j, k);
      PALPATE_INDEPENDENT
      for (int i = 0; i < brick_edge; ++i) {
        row[i] = middle * c[i] + w.x * (c[i - 1] + c[i + 1]) + w.y * (c[i - bent_width] + c[i + bent_width]) +
                 w.z * (c[i - plane] + c[i + plane]);
      }
    }
  }
}

/// One step of a brick's nodes down the slope and back within the bounds. Returns how much the step turned back.
PALPATE_FOR_PROCESSOR
float step_within(const float* slope, const float* kinks, float step, float onward, const Rows& rows,
                  const float* lower, const float* upper, const float* at, float* f, float* next_at) {
  std::array<float, brick_edge> turned{};
  for (int k = rows.low_k; k <= rows.high_k; ++k) {
    for (int j = rows.low_j; j <= rows.high_j; ++j) {
      const std::size_t n = NodeBricks::at(0, j, k);
      PALPATE_INDEPENDENT
      for (std::size_t i = 0; i < brick_edge; ++i) {
        const float down = step * (slope[n + i] - kinks[n + i]);
        float next = at[n + i] - (down == down ? down : 0.0F);  // what reaches beyond the bricks stays
        next = next < lower[n + i] ? lower[n + i] : next;
        next = next > upper[n + i] ? upper[n + i] : next;
        const float moved = next - f[n + i];
        turned[i] += (at[n + i] - next) * moved;
        f[n + i] = next;
        next_at[n + i] = next + onward * moved;
      }
    }
  }
  float sum = 0;
  for (const float part : turned) sum += part;
  return sum;
}

class Smoothing {
 public:
  Smoothing(const DistanceBounds& bounds, std::vector<float> first, int threads)
      : bounds_(bounds),
        bricks_(bounds.bricks),
        stencil_(stencil_of(bounds.bricks.lattice)),
        threads_(threads),
        lower_(first.size()),
        upper_(first.size()),
        f_(std::move(first)),
        far_(f_),
        kinks_(f_.size()) {}

  /// Nodes farther than this from the surface keep its distance. So do nodes at a kink of the distance, half-way
  /// between two sides: smoothing there would move the sides. The others are free within their bounds.
  void hold_beyond(float free_mm) {
    std::vector<char> any(bricks_.count(), 0);
    rows_.resize(bricks_.count());
    for_stretches(bricks_.count(), [&](std::size_t slot) {
      const std::size_t first = slot * brick_nodes;
      const auto is_near = [&](float mm) { return std::abs(mm) < free_mm; };
      std::array<bool, brick_nodes> free{};
      if (std::any_of(far_.begin() + static_cast<std::ptrdiff_t>(first),
                      far_.begin() + static_cast<std::ptrdiff_t>(first + brick_nodes), is_near)) {
        any[slot] = find_free(slot, free_mm, free, kinks_.data() + first) ? 1 : 0;
        rows_[slot] = rows_of(free);
      }
      for (std::size_t n = 0; n < brick_nodes; ++n) {
        const std::size_t at = first + n;
        // On its own side, wherever a coarser lattice has put the surface.
        float held = far_[at];
        if (bounds_.lower[at] > 0) held = std::max(held, std::min(bounds_.lower[at], least_mm));
        if (bounds_.upper[at] < 0) held = std::min(held, std::max(bounds_.upper[at], -least_mm));
        lower_[at] = free[n] ? bounds_.lower[at] : held;
        upper_[at] = free[n] ? bounds_.upper[at] : held;
        f_[at] = std::clamp(f_[at], lower_[at], upper_[at]);
      }
    });
    active_.clear();
    for (std::size_t slot = 0; slot < any.size(); ++slot) {
      if (any[slot] != 0) active_.push_back(slot);
    }
  }

  /// Accelerated projected gradient steps on |Laplacian f|^2.
  void descend(int steps) {
    const Stencil& w = stencil_;
    const float most = 4.0F * (w.x + w.y + w.z);  // the largest eigenvalue of the Laplacian
    const float step = 1.0F / (most * most);
    std::vector<float> at = f_;
    std::vector<float> next_at = f_;
    std::vector<double> against(active_.size());
    double t = 1;
    for (int n = 0; n < steps; ++n) {
      const double next_t = 0.5 * (1 + std::sqrt(1 + 4 * t * t));
      const auto onward = static_cast<float>((t - 1) / next_t);
      for_stretches(active_.size(), [&](std::size_t which) {
        const std::size_t first = active_[which] * brick_nodes;
        BentNodes around;
        gather<2, float>(bricks_, at, active_[which], no_node, around.data());
        std::array<float, brick_nodes> slope;
        const Rows& rows = rows_[active_[which]];
        bilaplacian(around.data(), w, rows, slope.data());
        against[which] = static_cast<double>(step_within(slope.data(), kinks_.data() + first, step, onward, rows,
                                                         lower_.data() + first, upper_.data() + first,
                                                         at.data() + first, f_.data() + first, next_at.data() + first));
      });
      at.swap(next_at);
      t = next_t;
      // Where the steps overshoot, begin again from rest.
      double sum = 0;
      for (const double part : against) sum += part;
      if (sum > 0) {
        t = 1;
        at = f_;
      }
    }
  }

  /// The distance from the surface that there is now.
  void measure(double band_mm) {
    const std::vector<Vec3f> closest = closest_points(bricks_, f_, band_mm, threads_);
    const Vec3f spacing(bricks_.lattice.spacing);
    for (std::size_t slot = 0; slot < bricks_.count(); ++slot) {
      const glm::ivec3 corner = bricks_.place[slot] * brick_edge;
      for (int n = 0; n < static_cast<int>(brick_nodes); ++n) {
        const Vec3f node(corner +
                         glm::ivec3(n % brick_edge, n / brick_edge % brick_edge, n / (brick_edge * brick_edge)));
        const std::size_t index = slot * brick_nodes + static_cast<std::size_t>(n);
        const float distance = glm::distance(node * spacing, closest[index]);
        if (distance < unsaid) far_[index] = std::copysign(distance, f_[index]);
      }
    }
  }

  const std::vector<float>& distance() const { return far_; }
  std::vector<float> take() { return std::move(f_); }

 private:
  static Rows rows_of(const std::array<bool, brick_nodes>& free) {
    Rows rows{.low_j = brick_edge, .high_j = -1, .low_k = brick_edge, .high_k = -1};
    for (int n = 0; n < static_cast<int>(brick_nodes); ++n) {
      if (!free[static_cast<std::size_t>(n)]) continue;
      const int j = n / brick_edge % brick_edge, k = n / (brick_edge * brick_edge);
      rows = {.low_j = std::min(rows.low_j, j),
              .high_j = std::max(rows.high_j, j),
              .low_k = std::min(rows.low_k, k),
              .high_k = std::max(rows.high_k, k)};
    }
    return rows;
  }

  /// Marks a brick's free nodes; returns whether there are any. `kinks`: the Laplacian of the parts bent only at kinks.
  bool find_free(std::size_t slot, float free_mm, std::array<bool, brick_nodes>& free, float* kinks) const {
    constexpr float steep_enough = 0.5F;  // squared slope of a distance: 1 but for its kinks
    constexpr std::ptrdiff_t plane = bent_width * bent_width;
    const Vec3f twice = 2.0F * Vec3f(bricks_.lattice.spacing);
    BentNodes around, bent{};
    gather<2, float>(bricks_, far_, slot, no_node, around.data());
    const auto is_smooth = [&](const float* c) {
      const Vec3f slope = Vec3f(c[1] - c[-1], c[bent_width] - c[-bent_width], c[plane] - c[-plane]) / twice;
      return !(glm::dot(slope, slope) <= steep_enough);
    };
    for (int k = 1; k < bent_width - 1; ++k) {
      for (int j = 1; j < bent_width - 1; ++j) {
        for (int i = 1; i < bent_width - 1; ++i) {
          const std::ptrdiff_t at = (k * bent_width + j) * bent_width + i;
          if (!is_smooth(around.data() + at))
            bent[static_cast<std::size_t>(at)] = laplacian(around.data() + at, stencil_);
        }
      }
    }
    std::array<float, brick_nodes> complete;  // NaN if a neighbor is no node
    bilaplacian(around.data(), stencil_, Rows(), complete.data());
    bool any = false;
    for (int n = 0; n < static_cast<int>(brick_nodes); ++n) {
      const std::ptrdiff_t in =
          ((n / (brick_edge * brick_edge) + 2) * bent_width + n / brick_edge % brick_edge + 2) * bent_width +
          n % brick_edge + 2;
      const float* c = around.data() + in;
      const auto at = static_cast<std::size_t>(n);
      free[at] = std::abs(*c) < free_mm && is_smooth(c) && std::isfinite(complete[at]);
      kinks[at] = laplacian(bent.data() + in, stencil_);
      any = any || free[at];
    }
    return any;
  }

  template <typename Work>
  void for_stretches(std::size_t count, const Work& work) const {
    constexpr std::size_t stretch = 16;
    internal::parallel_for((count + stretch - 1) / stretch,
                           [&](std::size_t n) {
                             const std::size_t end = std::min(count, (n + 1) * stretch);
                             for (std::size_t which = n * stretch; which < end; ++which) work(which);
                           },
                           {}, threads_);
  }

  const DistanceBounds& bounds_;
  const NodeBricks& bricks_;
  Stencil stencil_;
  int threads_;
  std::vector<float> lower_, upper_, f_, far_, kinks_;
  std::vector<std::size_t> active_;
  std::vector<Rows> rows_;  ///< of each brick
};

/// Half-way between inside and outside.
std::vector<float> first_guess(const DistanceBounds& bounds) {
  std::vector<float> f(bounds.lower.size());
  for (std::size_t n = 0; n < f.size(); ++n) f[n] = 0.5F * (bounds.lower[n] + bounds.upper[n]);
  return f;
}

/// How far from the surface nodes are free, mm: some nodes of the lattice.
double free_for(const NodeLattice& lattice) {
  constexpr double free_nodes = 4;
  const Vec3& h = lattice.spacing;
  return free_nodes * std::cbrt(h.x * h.y * h.z);
}

}  // namespace

std::vector<float> smoothest(const DistanceBounds& bounds, const SmoothestOptions& options) {
  std::vector<Coarser> coarse;
  coarse.reserve(static_cast<std::size_t>(options.coarser));
  std::vector<float> first = first_guess(bounds);
  const auto most_mm = static_cast<float>(2 * free_for(bounds.bricks.lattice));
  for (int n = 0; n < options.coarser; ++n) {
    coarse.push_back(n == 0 ? coarser(bounds, first, most_mm)
                            : coarser(coarse.back().bounds, coarse.back().f, most_mm));
  }
  for (std::size_t n = coarse.size(); n > 0; --n) {
    Coarser& here = coarse[n - 1];
    const double free_mm = free_for(here.bounds.bricks.lattice);
    Smoothing smoothing(here.bounds, std::move(here.f), options.threads);
    if (n == coarse.size()) smoothing.measure(2 * free_mm);
    for (int round = 0; round < options.coarse_rounds; ++round) {
      smoothing.hold_beyond(static_cast<float>(free_mm));
      smoothing.descend(options.steps);
      smoothing.measure(2 * free_mm);
    }
    refine(here.bounds.bricks, smoothing.distance(), n == 1 ? bounds.bricks : coarse[n - 2].bounds.bricks,
           n == 1 ? first : coarse[n - 2].f);
  }
  const double free_mm = free_for(bounds.bricks.lattice);
  Smoothing smoothing(bounds, std::move(first), options.threads);
  for (int round = 0; round < options.rounds; ++round) {
    if (round > 0) smoothing.measure(2 * free_mm);
    smoothing.hold_beyond(static_cast<float>(free_mm));
    smoothing.descend(options.steps);
  }
  return smoothing.take();
}

}  // namespace palpate::io
