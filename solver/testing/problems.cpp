#include "solver/testing/problems.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

namespace palpate::solver {

namespace {

// Of a stylus: the workspace (m), how far the probe moves from the proxy (m), and what a hand feels (N).
constexpr double workspace = 0.05;
constexpr double travel = 3e-3;
constexpr double strongest = 2;

Primitive any_primitive(Random& random, double strength, const Vec3& position) {
  switch (random.below(4)) {
    case 0:
      return make_directed_force(strength, random.unit_vector());
    case 1:
      return make_plane(strength, position, random.unit_vector());
    case 2:
      return make_line(strength, position, random.unit_vector());
    default:
      return make_point(strength, position);
  }
}

Primitive any_constraint(Random& random, double strength, const Vec3& position) {
  Primitive primitive = any_primitive(random, strength, position);
  while (primitive.type == PrimitiveType::directed_force) {
    primitive = any_primitive(random, strength, position);
  }
  return primitive;
}

double any_strength(Random& random) {
  return random.uniform(0, strongest);
}

void add_allowed(Random& random, Problem& problem) {
  const Vec3 at = problem.previous_proxy;
  const Vec3 a = random.unit_vector();
  const Vec3 b = glm::normalize(glm::cross(a, random.unit_vector()));
  const Vec3 axes[] = {a, b, glm::cross(a, b)};
  auto& primitives = problem.primitives;
  for (std::size_t i = random.below(3); i > 0; --i) {
    primitives.push_back(make_directed_force(any_strength(random), random.unit_vector()));
  }
  const std::size_t planes = random.below(4);
  for (std::size_t i = 0; i < planes; ++i) {
    const Vec3 normal = axes[random.below(3)] * (random.below(2) == 0 ? 1.0 : -1.0);
    primitives.push_back(make_plane(any_strength(random), at, normal));
  }
  const Vec3 along = axes[random.below(3)];
  for (std::size_t i = random.below(3); i > 0; --i) {
    primitives.push_back(make_line(any_strength(random), at, along));
  }
  for (std::size_t i = random.below(3); i > 0; --i) {
    primitives.push_back(make_point(any_strength(random), at));
  }
}

void add_oblique(Random& random, Problem& problem) {
  problem.primitives.push_back(make_directed_force(any_strength(random), random.unit_vector()));
  for (std::size_t i = 1 + random.below(3); i > 0; --i) {
    problem.primitives.push_back(any_constraint(random, any_strength(random), problem.previous_proxy));
  }
}

void add_near_parallel(Random& random, Problem& problem) {
  const Vec3 q = random.unit_vector();
  const Vec3 at = problem.previous_proxy;
  const std::size_t count = 2 + random.below(3);
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = random.log_uniform(1e-15, 1e-3);
    const Vec3 turned = glm::normalize(q + random.unit_vector() * angle);
    const Vec3 position = at + (random.below(2) == 0 ? Vec3{0} : random.normal_vector(travel / 3));
    if (random.below(2) == 0) {
      problem.primitives.push_back(make_line(any_strength(random), position, turned));
    } else {
      problem.primitives.push_back(make_plane(any_strength(random), position, random.below(3) == 0 ? -turned : turned));
    }
  }
}

void add_edge(Random& random, Problem& problem) {
  const Vec3 at = problem.previous_proxy;
  const std::size_t count = 1 + random.below(3);
  const double pull = glm::length(problem.probe - at) * problem.stiffness;
  const Vec3 towards = glm::normalize(at - problem.probe);
  for (std::size_t i = 0; i < count; ++i) {
    // The strengths add up to the pull, within the rounding of the last of them.
    Primitive primitive = any_constraint(random, pull / static_cast<double>(count), at);
    const bool aligned = random.below(2) == 0;
    if (aligned && primitive.type == PrimitiveType::plane) {
      primitive.direction = towards;
    } else if (aligned && primitive.type == PrimitiveType::line) {
      primitive.direction = glm::normalize(glm::cross(towards, random.unit_vector()));
    }
    problem.primitives.push_back(primitive);
  }
  if (random.below(4) == 0) {
    problem.probe = at;
  }
}

void add_stiff(Random& random, Problem& problem) {
  problem.stiffness = random.log_uniform(1e-3, 1e9);
  const std::size_t count = 1 + random.below(6);
  for (std::size_t i = 0; i < count; ++i) {
    const double strength = random.below(8) == 0 ? 0 : random.log_uniform(1e-6, 1e12);
    const Vec3 position = problem.previous_proxy + (random.below(2) == 0 ? Vec3{0} : random.normal_vector(travel));
    problem.primitives.push_back(any_primitive(random, strength, position));
  }
}

void add_hard(Random& random, Problem& problem) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Vec3 common = problem.previous_proxy;
  const std::size_t count = 1 + random.below(3);
  for (std::size_t i = 0; i < count; ++i) {
    problem.primitives.push_back(any_constraint(random, infinity, common));
    Primitive& primitive = problem.primitives.back();
    if (primitive.type == PrimitiveType::plane && random.below(2) == 0) {
      primitive.position -= primitive.direction * random.uniform(0, travel);
    }
  }
  for (std::size_t i = random.below(4); i > 0; --i) {
    problem.primitives.push_back(any_primitive(random, any_strength(random), common + random.normal_vector(travel)));
  }
}

void add_tiny(Random& random, Problem& problem) {
  const Vec3 at = random.below(2) == 0 ? Vec3{0} : problem.previous_proxy;
  problem.previous_proxy = at;
  problem.probe = at + random.unit_vector() * random.log_uniform(1e-300, 1e-6);
  const std::size_t count = 1 + random.below(5);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 position = at + random.unit_vector() * random.log_uniform(1e-300, 1e-6);
    problem.primitives.push_back(any_primitive(random, random.log_uniform(1e-12, 1), position));
  }
}

}  // namespace

const char* name_of(Family family) {
  switch (family) {
    case Family::allowed:
      return "allowed";
    case Family::oblique:
      return "oblique";
    case Family::co_located:
      return "co-located";
    case Family::spread:
      return "spread";
    case Family::near_parallel:
      return "near-parallel";
    case Family::edge:
      return "edge";
    case Family::stiff:
      return "stiff";
    case Family::hard:
      return "hard";
    case Family::far_away:
      return "far";
    case Family::tiny:
      return "tiny";
    case Family::many:
      return "many";
  }
  return "unknown";
}

Problem make_problem(Family family, std::uint64_t seed, std::size_t count) {
  Random random(seed * 16 + static_cast<std::uint64_t>(family));
  Problem problem;
  problem.stiffness = random.uniform(200, 2000);
  problem.previous_proxy = random.normal_vector(workspace);
  problem.probe = problem.previous_proxy + random.normal_vector(travel);
  const auto fill = [&](std::size_t usual, double spread) {
    for (std::size_t i = count > 0 ? count : usual; i > 0; --i) {
      const Vec3 position = problem.previous_proxy + (spread > 0 ? random.normal_vector(spread) : Vec3{0});
      problem.primitives.push_back(any_primitive(random, any_strength(random), position));
    }
  };
  switch (family) {
    case Family::allowed:
      add_allowed(random, problem);
      break;
    case Family::oblique:
      add_oblique(random, problem);
      break;
    case Family::co_located:
      fill(1 + random.below(10), 0);
      break;
    case Family::spread:
      fill(1 + random.below(10), travel);
      break;
    case Family::near_parallel:
      add_near_parallel(random, problem);
      break;
    case Family::edge:
      add_edge(random, problem);
      break;
    case Family::stiff:
      add_stiff(random, problem);
      break;
    case Family::hard:
      add_hard(random, problem);
      break;
    case Family::far_away: {
      fill(1 + random.below(6), random.below(2) == 0 ? 0 : travel);
      const Vec3 shift = random.unit_vector() * random.log_uniform(1, 1e6);
      problem.probe += shift;
      problem.previous_proxy += shift;
      for (Primitive& primitive : problem.primitives) {
        primitive.position += shift;
      }
      break;
    }
    case Family::tiny:
      add_tiny(random, problem);
      break;
    case Family::many:
      fill(100, travel);
      break;
  }
  return problem;
}

std::uint64_t Random::bits() {
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

double Random::uniform(double from, double to) {
  return from + (to - from) * (static_cast<double>(bits() >> 11) * 0x1p-53);
}

double Random::log_uniform(double from, double to) {
  return std::exp(uniform(std::log(from), std::log(to)));
}

std::size_t Random::below(std::size_t count) {
  return static_cast<std::size_t>(bits() % count);
}

Vec3 Random::unit_vector() {
  const double z = uniform(-1, 1);
  const double angle = uniform(0, 2 * std::numbers::pi);
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(angle), r * std::sin(angle), z};
}

Vec3 Random::normal_vector(double deviation) {
  double component[3];
  for (double& c : component) {
    // G. E. P. Box, M. E. Muller, 1958.
    c = deviation * std::sqrt(-2 * std::log(1 - uniform(0, 1))) * std::cos(uniform(0, 2 * std::numbers::pi));
  }
  return {component[0], component[1], component[2]};
}

}  // namespace palpate::solver
