#include "plugin/bench/force_paths.h"

#include <glm/geometric.hpp>

namespace palpate::plugin {
namespace {

constexpr double walk_mm = 0.5;
constexpr int most_tries = 400;

/// From the target outwards; empty if the way breaks the rule.
std::optional<glm::dvec3> way_out(const PathWorld& world, const PathTarget& target, const glm::dvec3& place,
                                  const glm::dvec3& outward) {
  double outside_from = -1;
  for (double way = 0; way <= world.most_mm + world.before_mm; way += walk_mm) {
    const glm::dvec3 at = place + way * outward;
    if (!world.is_known(at)) return std::nullopt;
    if (!target.is_bone && world.is_bone(at)) return std::nullopt;
    if (!world.is_outside(at)) {
      outside_from = -1;  // it was a cavity, or a fold of the skin
    } else if (outside_from < 0) {
      outside_from = way;
    } else if (way - outside_from >= world.before_mm) {
      return at;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<PlannedPath> plan_path(const PathWorld& world, std::uint64_t seed, std::size_t number) {
  std::seed_seq mixed{seed & 0xffffffffU, seed >> 32U, static_cast<std::uint64_t>(number)};
  std::mt19937_64 random(mixed);
  std::normal_distribution<double> any;
  const std::size_t n = number % world.targets.size();
  for (int tries = 0; tries < most_tries; ++tries) {
    const glm::dvec3 place = world.targets[n].place_in(random);
    const double x = any(random), y = any(random), z = any(random);
    const glm::dvec3 outward = glm::normalize(world.stretch * glm::normalize(glm::dvec3(x, y, z)));
    if (const auto from = way_out(world, world.targets[n], place, outward)) {
      return PlannedPath{.from_mm = *from, .to_mm = place, .target = n};
    }
  }
  return std::nullopt;
}

}  // namespace palpate::plugin
