#pragma once

/// Seeded balances of every kind that the solvers promise to solve, for tests, benchmarks and studies. The same family,
/// seed and count give the same balance on every platform.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/balance.h"

namespace palpate::solver {

enum class Family : std::uint8_t {
  allowed,        ///< co-located, orthogonal or merged: section 3.1's conditions
  oblique,        ///< one to three constraints and a force, co-located, any directions
  co_located,     ///< up to ten of any type at the old proxy
  spread,         ///< up to ten of any type within 3 mm of the old proxy
  near_parallel,  ///< directions 1e-15 to 1e-3 rad apart, some opposed
  edge,           ///< the pull equals the strength to the last bit, or the probe is exactly on a primitive
  stiff,          ///< stiffness 1e-3 to 1e9 N/m, strengths 0 to 1e12 N
  hard,           ///< some strengths infinite, with a common point
  far_away,       ///< the whole scene moved by up to 1e6 m
  tiny,           ///< offsets of 1e-300 to 1e-6 m
  many            ///< 100 of any type, spread, unless a count is given
};

inline constexpr Family all_families[] = {Family::allowed,       Family::oblique, Family::co_located, Family::spread,
                                          Family::near_parallel, Family::edge,    Family::stiff,      Family::hard,
                                          Family::far_away,      Family::tiny,    Family::many};

const char* name_of(Family family);

/// A balance with its primitives.
struct Problem {
  double stiffness = 400;  ///< N/m
  Vec3 probe{0};           ///< m
  Vec3 previous_proxy{0};  ///< m
  std::vector<Primitive> primitives;

  Balance balance() const { return {stiffness, probe, previous_proxy, primitives}; }
};

/// count: the number of primitives; 0: the family's default.
Problem make_problem(Family family, std::uint64_t seed, std::size_t count = 0);

/// Uniform and normal numbers that are the same on every platform (S. Vigna's splitmix64).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits();
  double uniform(double from, double to);
  double log_uniform(double from, double to);
  std::size_t below(std::size_t count);
  Vec3 unit_vector();
  /// Each component normal with the deviation given.
  Vec3 normal_vector(double deviation);

 private:
  std::uint64_t state_;
};

}  // namespace palpate::solver
