#include "io/structures/coarse_change.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <unordered_set>

#include "io/parallel.h"
#include "io/structures/coarse_distance.h"

namespace palpate::io::internal {
namespace {

constexpr double true_within_mm = 20, fades_over_mm = 12;
constexpr double cell_mm = 2;  // one point of the surface for each such cell is enough beyond the bricks
constexpr double unchanged_mm = 1e-4;

/// One point of each cell, in patient space.
std::vector<Vec3f> thinned(const std::vector<Vec3f>& points, const NodeLattice& lattice) {
  std::unordered_set<std::uint64_t> taken;
  std::vector<Vec3f> kept;
  for (const Vec3f& point : points) {
    const glm::ivec3 cell(glm::floor(point / static_cast<float>(cell_mm)));
    const auto part = [](int of) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(of) & 0x1fffffU); };
    if (!taken.insert(part(cell.x) << 42U | part(cell.y) << 21U | part(cell.z)).second) continue;
    kept.emplace_back(lattice.origin + lattice.axes * Vec3(point));
  }
  return kept;
}

constexpr int block = 4;  // nodes along i and j that share their stretches

/// The stretches that can be nearest to a place within so many mm of a middle.
std::vector<Stretch> nearest_around(std::span<const Stretch> where, const Vec3& middle, double within_mm) {
  std::vector<double> away(where.size());
  std::ranges::transform(where, away.begin(), [&](const Stretch& one) { return distance_to(one, middle); });
  const double most = *std::ranges::min_element(away) + 2 * within_mm + 1e-6;
  std::vector<Stretch> near;
  for (std::size_t n = 0; n < where.size(); ++n) {
    if (away[n] <= most) near.push_back(where[n]);
  }
  return near;
}

}  // namespace

void change_coarse(const CoarseChange& change, int threads, DistanceParts& parts) {
  DistanceParts::Coarse& far = parts.far;
  Vec3 low(1e9), high(-1e9);
  for (const Stretch& stretch : change.where) {
    low = glm::min(low, glm::min(stretch.from, stretch.to));
    high = glm::max(high, glm::max(stretch.from, stretch.to));
  }
  const double around = change.within_mm + true_within_mm + fades_over_mm;
  constexpr int margin = 3;  // so that whatever a changed node is interpolated into lies in the patch
  glm::ivec3 first = glm::ivec3(glm::floor((low - around - far.origin) / far.spacing)) - margin;
  glm::ivec3 last = glm::ivec3(glm::ceil((high + around - far.origin) / far.spacing)) + margin;
  if (far.patch_mm) {
    first = glm::min(first, far.patch_low);
    last = glm::max(last, far.patch_low + far.patch_size - 1);
  }
  first = glm::clamp(first, glm::ivec3(0), far.size - 1);
  last = glm::clamp(last, glm::ivec3(0), far.size - 1);
  const glm::ivec3 size = last - first + 1;
  std::vector<float> mm(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                        static_cast<std::size_t>(size.z));
  std::vector<char> any(static_cast<std::size_t>(size.z));
  const CoarseLattice box{.origin = far.origin + Vec3(first) * far.spacing, .spacing = far.spacing, .size = size};
  std::vector<Vec3f> near_surface, near_lost;
  parallel_for(
      2,
      [&](std::size_t n) {
        (n == 0 ? near_surface : near_lost) =
            closest_of(box, thinned(n == 0 ? change.surface : change.lost, change.lattice));
      },
      {}, threads);
  const glm::ivec2 blocks = (glm::ivec2(size) + block - 1) / block;
  const double half_block_mm = 0.5 * std::sqrt(2.0) * (block - 1) * far.spacing;
  parallel_for(
      static_cast<std::size_t>(size.z),
      [&](std::size_t k) {
        float* into = mm.data() + k * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
        std::vector<std::vector<Stretch>> near_block(static_cast<std::size_t>(blocks.x * blocks.y));
        for (int n = 0; n < blocks.x * blocks.y; ++n) {
          const Vec3 middle(Vec3(first) + Vec3(n % blocks.x * block + 0.5 * (block - 1),
                                               n / blocks.x * block + 0.5 * (block - 1), static_cast<double>(k)));
          near_block[static_cast<std::size_t>(n)] =
              nearest_around(change.where, far.origin + middle * far.spacing, half_block_mm);
        }
        for (int j = 0; j < size.y; ++j) {
          for (int i = 0; i < size.x; ++i, ++into) {
            const glm::ivec3 node = first + glm::ivec3(i, j, static_cast<int>(k));
            const float before = far.at(node.x, node.y, node.z);
            *into = before;
            const Vec3 at = far.origin + Vec3(node) * far.spacing;
            if (glm::any(glm::lessThan(at, low - around)) || glm::any(glm::greaterThan(at, high + around))) continue;
            double away = nowhere;
            for (const Stretch& stretch : near_block[static_cast<std::size_t>(j / block * blocks.x + i / block)]) {
              away = std::min(away, distance_to(stretch, at));
            }
            away -= change.within_mm;
            if (away > true_within_mm + fades_over_mm) continue;
            Distance near;
            double now = 0;
            if (parts.sample_near(at, near)) {
              now = near.mm;
            } else {
              const auto n = static_cast<std::size_t>(into - mm.data());
              const float new_mm = glm::distance(near_surface[n], Vec3f(at));
              const float old_mm = glm::distance(near_lost[n], Vec3f(at));
              const bool still_there = std::abs(before) < old_mm - 0.5F;
              const double length = still_there ? std::min(std::abs(before), new_mm) : new_mm;
              now = std::copysign(length, change.after(at, before));
            }
            const double part = std::clamp((away - true_within_mm) / fades_over_mm, 0.0, 1.0);
            if ((now > 0) == (before > 0)) now += part * part * (3 - 2 * part) * (before - now);
            if (std::abs(now - before) > unchanged_mm) {
              *into = static_cast<float>(now);
              any[k] = 1;
            }
          }
        }
      },
      {}, threads);
  if (std::ranges::none_of(any, [](char one) { return one != 0; })) return;
  far.patch_low = first;
  far.patch_size = size;
  far.patch_mm = std::make_shared<const std::vector<float>>(std::move(mm));
}

}  // namespace palpate::io::internal
