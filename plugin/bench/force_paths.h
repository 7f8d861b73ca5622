#pragma once

/// Straight paths from outside a body to places in its organs, planned at random under a rule, as a needle's are
/// (Mastmeyer et al., Scientific Reports 7:671, 2017).

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace palpate::plugin {

/// Patient space, mm.
struct PlannedPath {
  glm::dvec3 from_mm{0};
  glm::dvec3 to_mm{0};
  std::size_t target = 0;  ///< index into PathWorld::targets
};

struct PathTarget {
  std::string name;
  std::function<glm::dvec3(std::mt19937_64&)> place_in;  ///< a random place inside, uniformly distributed
  bool is_bone = false;                                  ///< then the path may pass through bone
};

struct PathWorld {
  std::vector<PathTarget> targets;
  std::function<bool(const glm::dvec3&)> is_outside;  ///< whether a place is outside the body
  std::function<bool(const glm::dvec3&)> is_bone;
  std::function<bool(const glm::dvec3&)> is_known;  ///< whether a place is in the scan
  glm::dvec3 stretch{1};  ///< scales uniformly distributed directions: a slab is entered from its sides
  double most_mm = 200;   ///< in the body
  double before_mm = 6;   ///< length of the path outside
};

/// The path with this number, which depends only on the seed and the number. The targets take turns. Empty if no
/// allowed path to the target was found.
std::optional<PlannedPath> plan_path(const PathWorld& world, std::uint64_t seed, std::size_t number);

}  // namespace palpate::plugin
