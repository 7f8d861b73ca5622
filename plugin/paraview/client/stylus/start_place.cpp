#include "plugin/paraview/client/stylus/start_place.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <queue>
#include <vector>

#include "io/bounding_box.h"
#include "io/fields/volume_fields.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {
namespace {

constexpr int most_cells = 48;  // along the longest side
constexpr double finger_mm = 15;

/// Cells of even size over the scan's box.
class Grid {
 public:
  explicit Grid(const io::Box& box) : low_(box.low) {
    const glm::dvec3 size = glm::max(box.high - box.low, glm::dvec3(1e-3));
    const double cell = std::max({size.x, size.y, size.z}) / most_cells;
    count_ = glm::max(glm::ivec3(glm::ceil(size / cell)), glm::ivec3(1));
    step_ = size / glm::dvec3(count_);
  }
  std::size_t size() const { return static_cast<std::size_t>(count_.x) * count_.y * count_.z; }
  const glm::ivec3& count() const { return count_; }
  const glm::dvec3& step() const { return step_; }
  bool contains(const glm::ivec3& cell) const {
    return glm::all(glm::greaterThanEqual(cell, glm::ivec3(0))) && glm::all(glm::lessThan(cell, count_));
  }
  std::size_t index(const glm::ivec3& cell) const {
    return (static_cast<std::size_t>(cell.z) * count_.y + cell.y) * count_.x + cell.x;
  }
  glm::ivec3 cell(std::size_t index) const {
    const auto n = static_cast<int>(index);
    return {n % count_.x, n / count_.x % count_.y, n / (count_.x * count_.y)};
  }
  glm::dvec3 place(const glm::ivec3& cell) const { return low_ + (glm::dvec3(cell) + 0.5) * step_; }

 private:
  glm::dvec3 low_;
  glm::dvec3 step_{1};
  glm::ivec3 count_{1};
};

constexpr glm::ivec3 neighbours[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

/// The distance, in cells, from the nearest marked cell.
std::vector<int> steps_from(const Grid& grid, const std::vector<bool>& marked) {
  std::vector<int> steps(grid.size(), -1);
  std::queue<std::size_t> next;
  for (std::size_t n = 0; n < grid.size(); ++n) {
    if (!marked[n]) continue;
    steps[n] = 0;
    next.push(n);
  }
  for (; !next.empty(); next.pop()) {
    for (const glm::ivec3& way : neighbours) {
      const glm::ivec3 cell = grid.cell(next.front()) + way;
      if (!grid.contains(cell) || steps[grid.index(cell)] >= 0) continue;
      steps[grid.index(cell)] = steps[next.front()] + 1;
      next.push(grid.index(cell));
    }
  }
  return steps;
}

/// Thin cells that hang together with the scan's sides. Not with its ends: a scan may be cut through the lung.
std::vector<bool> outside_of(const Grid& grid, const std::vector<bool>& tissue) {
  std::vector<bool> outside(grid.size());
  std::queue<std::size_t> next;
  const auto add = [&](std::size_t n) {
    if (tissue[n] || outside[n]) return;
    outside[n] = true;
    next.push(n);
  };
  for (std::size_t n = 0; n < grid.size(); ++n) {
    const glm::ivec3 cell = grid.cell(n);
    if (cell.x == 0 || cell.y == 0 || cell.x == grid.count().x - 1 || cell.y == grid.count().y - 1) add(n);
  }
  for (; !next.empty(); next.pop()) {
    for (const glm::ivec3& way : neighbours) {
      const glm::ivec3 cell = grid.cell(next.front()) + way;
      if (grid.contains(cell)) add(grid.index(cell));
    }
  }
  return outside;
}

std::vector<bool> inverted(std::vector<bool> marked) {
  marked.flip();
  return marked;
}

bool is_felt(const modes::Plan& plan, const io::FieldSource& fields, const glm::dvec3& place) {
  const io::Sample sample = fields.sample(place, plan.fields);
  return sample.inside && std::ranges::any_of(plan.modes, [&](const modes::ActiveMode& mode) {
           return mode.type->finds_places && mode.strength(sample) > 0;
         });
}

}  // namespace

StartPlace find_start_place(const std::shared_ptr<const io::Volume>& volume, const modes::Plan& plan,
                            double gradient_scale_mm, const std::function<bool(const glm::dvec3&)>& in_reach,
                            const std::function<bool(const glm::dvec3&)>& in_sight) {
  const io::VolumeFields fields(volume, scan_fields(plan) | io::FieldSet::value, gradient_scale_mm,
                                {.brick_bytes = 0, .background = false});
  const Grid grid(bounding_box(volume->geometry));
  std::vector<double> values(grid.size(), NAN);
  double lowest = 1e300, highest = -1e300;
  for (std::size_t n = 0; n < grid.size(); ++n) {
    const io::Sample sample = fields.sample(grid.place(grid.cell(n)), io::FieldSet::value);
    if (!sample.inside) continue;
    values[n] = sample.value;
    lowest = std::min(lowest, sample.value);
    highest = std::max(highest, sample.value);
  }
  const double threshold = volume->unit == "HU" ? -300 : lowest + 0.15 * (highest - lowest);
  std::vector<bool> tissue(grid.size());
  for (std::size_t n = 0; n < grid.size(); ++n) tissue[n] = values[n] > threshold;
  // A flow has no inside: what counts is that nothing is felt, as in the padding around a vessel.
  if (volume->vectors) {
    for (std::size_t n = 0; n < grid.size(); ++n) tissue[n] = is_felt(plan, fields, grid.place(grid.cell(n)));
  }
  const std::vector<bool> outside = volume->vectors ? inverted(tissue) : outside_of(grid, tissue);
  const std::vector<int> clearance = steps_from(grid, tissue);

  glm::dvec3 wanted = grid.place(grid.count() / 2);
  for (glm::ivec3 cell(grid.count().x / 2, 0, grid.count().z / 2); cell.y < grid.count().y / 2; ++cell.y) {
    if (!tissue[grid.index(cell)]) continue;
    wanted.y = std::max(grid.place(cell).y - finger_mm, grid.place({0, 0, 0}).y);
    break;
  }
  const double cell_mm = std::min({grid.step().x, grid.step().y, grid.step().z});
  struct Candidate {
    double cost;
    std::size_t n;
  };
  std::vector<Candidate> candidates;
  for (std::size_t n = 0; n < grid.size(); ++n) {
    const glm::dvec3 place = grid.place(grid.cell(n));
    if (!in_reach(place)) continue;
    constexpr double enough_mm = 5, never_mm = 1e4;
    const double clear_mm = clearance[n] < 0 ? enough_mm : clearance[n] * cell_mm;
    const double off = glm::distance(place, wanted);
    candidates.push_back({off + 4 * std::max(0.0, enough_mm - clear_mm) + (outside[n] ? 0 : never_mm), n});
  }
  std::ranges::sort(candidates, {}, &Candidate::cost);
  // The nearest that is all that is wanted; else the nearest that is outside; else the nearest.
  StartPlace best{.place_mm = wanted};
  for (const Candidate& one : candidates) {
    const glm::dvec3 place = grid.place(grid.cell(one.n));
    if (!outside[one.n] || clearance[one.n] == 1 || is_felt(plan, fields, place)) continue;
    if (!best.outside) best = {.place_mm = place, .outside = true, .seen = false};
    if (!in_sight(place)) continue;
    best.seen = true;
    best.place_mm = place;
    return best;
  }
  if (!best.outside && !candidates.empty()) best.place_mm = grid.place(grid.cell(candidates.front().n));
  return best;
}

}  // namespace palpate::plugin
