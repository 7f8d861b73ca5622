/// What the mathematics says of every force balance, over seeded balances of all families. PALPATE_CASES in the
/// environment sets how many of each law's cases are tried in all (the default fits a test run; 1000000 takes minutes).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <iterator>
#include <span>
#include <vector>

#include "solver/analytical.h"
#include "solver/certify.h"
#include "solver/chain.h"
#include "solver/exact.h"
#include "solver/testing/problems.h"
#include "solver/testing/reference.h"
#include "solver/testing/values.h"

namespace palpate::solver {
namespace {

// Cases of each family, of a law that by default has `usual` cases in all and whose cases are `slowness` times as slow.
std::uint64_t cases(std::uint64_t usual, std::uint64_t slowness = 1) {
  const char* asked = std::getenv("PALPATE_CASES");
  const std::uint64_t all = asked != nullptr ? std::strtoull(asked, nullptr, 10) / slowness : usual;
  return std::max<std::uint64_t>(1, all / std::size(all_families));
}

// Has the law hold on so many balances of each family; fewer of many primitives, which take long.
template <typename Law>
void expect_of_all(std::span<const Family> families, std::uint64_t each, const Law& law) {
  for (const Family family : families) {
    const std::uint64_t count = family == Family::many ? std::max<std::uint64_t>(1, each / 100) : each;
    for (std::uint64_t seed = 0; seed < count && !::testing::Test::HasFatalFailure(); ++seed) {
      SCOPED_TRACE(::testing::Message() << name_of(family) << " " << seed);
      law(make_problem(family, seed), seed);
    }
  }
}

struct ExactAnswer {
  Solution solution;
  std::vector<Vec3> forces;
  double promise = 0;

  double bound() const { return solution.error_bound; }
};

ExactAnswer exact_answer_to(const Problem& problem) {
  static ExactScratch scratch(128);
  ExactAnswer answer;
  answer.forces.resize(problem.primitives.size());
  const Balance balance = problem.balance();
  answer.solution = solve_exact(balance, answer.forces, scratch);
  answer.promise = promised_accuracy(balance, answer.solution.proxy, answer.forces);
  return answer;
}

// Two answers to what is the same balance but for rounding.
void expect_same(const ExactAnswer& a, const ExactAnswer& b, const Vec3& apart) {
  ASSERT_EQ(a.solution.outcome, Outcome::solved);
  ASSERT_EQ(b.solution.outcome, Outcome::solved);
  EXPECT_LE(glm::length(apart), 4 * (a.promise + b.promise));
}

// Where an ulp of the data moves the proxy by about an ulp.
constexpr Family well_conditioned[] = {Family::allowed, Family::oblique, Family::co_located, Family::spread,
                                       Family::many};

TEST(Laws, EveryBalanceIsSolvedAndNoCapIsHit) {
  expect_of_all(all_families, cases(40000), [&](const Problem& problem, std::uint64_t) {
    const ExactAnswer answer = exact_answer_to(problem);
    ASSERT_EQ(answer.solution.outcome, Outcome::solved)
        << "of " << problem.primitives.size() << ", bound " << answer.bound();
    ASSERT_TRUE(std::isfinite(answer.bound()));
  });
}

TEST(Laws, NoBoundIsBelowTheTrueErrorAndTheAccuracyIsThatPromised) {
  std::size_t known = 0;
  std::size_t tried = 0;
  for (const Family family : all_families) {
    // A reference of 100 primitives takes long.
    for (std::uint64_t seed = 0; seed < (family == Family::many ? 1 : cases(440, 400)); ++seed) {
      const Problem problem = make_problem(family, seed);
      const Balance balance = problem.balance();
      const Reference reference = solve_reference(balance);
      const ExactAnswer exact = exact_answer_to(problem);
      const double error = distance_to(reference, balance, exact.solution.proxy);
      EXPECT_LE(error, exact.bound() + reference.radius) << name_of(family) << " " << seed;
      ++tried;
      if (reference.radius < 0.1 * exact.promise) {
        ++known;
        const bool ill_conditioned = family == Family::near_parallel || family == Family::stiff;
        EXPECT_LE(error, (ill_conditioned ? 1e3 : 1.1) * exact.promise) << name_of(family) << " " << seed;
      }
      std::vector<Vec3> forces(problem.primitives.size());
      const Solution pass = solve_analytical(balance, forces);
      if (pass.outcome == Outcome::solved) {
        EXPECT_LE(distance_to(reference, balance, pass.proxy), pass.error_bound + reference.radius)
            << name_of(family) << " " << seed;
      }
      const Certificate certificate = certify(balance, exact.solution.proxy, exact.forces);
      EXPECT_LE(error, certificate.error_bound + reference.radius) << name_of(family) << " " << seed;
    }
  }
  EXPECT_GE(10 * known, 8 * tried);
}

TEST(Laws, OrderDoesNotMatter) {
  expect_of_all(well_conditioned, cases(10000), [&](Problem problem, std::uint64_t seed) {
    const ExactAnswer forwards = exact_answer_to(problem);
    Random random(seed);
    for (std::size_t i = problem.primitives.size(); i > 1; --i) {
      std::swap(problem.primitives[i - 1], problem.primitives[random.below(i)]);
    }
    const ExactAnswer shuffled = exact_answer_to(problem);
    expect_same(forwards, shuffled, forwards.solution.proxy - shuffled.solution.proxy);
  });
}

struct Motion {
  Vec3 axis[3];
  Vec3 shift;

  Vec3 turn(const Vec3& v) const { return axis[0] * v.x + axis[1] * v.y + axis[2] * v.z; }
  Vec3 move(const Vec3& v) const { return turn(v) + shift; }
};

TEST(Laws, ARigidMotionMovesTheProxyAlong) {
  // Turned and rounded, what was orthogonal is no longer, but by an ulp: 'allowed' stays well-conditioned all the
  // same.
  expect_of_all(well_conditioned, cases(10000), [&](Problem problem, std::uint64_t seed) {
    const ExactAnswer here = exact_answer_to(problem);
    Random random(seed);
    Motion motion;
    motion.axis[0] = random.unit_vector();
    motion.axis[1] = glm::normalize(glm::cross(motion.axis[0], random.unit_vector()));
    motion.axis[2] = glm::cross(motion.axis[0], motion.axis[1]);
    motion.shift = random.normal_vector(0.05);
    problem.probe = motion.move(problem.probe);
    problem.previous_proxy = motion.move(problem.previous_proxy);
    for (Primitive& primitive : problem.primitives) {
      primitive.position = motion.move(primitive.position);
      primitive.direction = motion.turn(primitive.direction);
    }
    const ExactAnswer there = exact_answer_to(problem);
    expect_same(here, there, motion.move(here.solution.proxy) - there.solution.proxy);
  });
}

TEST(Laws, StiffnessAndStrengthsTogetherDoNotMatter) {
  expect_of_all(all_families, cases(10000), [&](Problem problem, std::uint64_t) {
    const ExactAnswer weak = exact_answer_to(problem);
    problem.stiffness *= 8;  // a power of two, so that the balance is the same to the last bit
    for (Primitive& primitive : problem.primitives) {
      primitive.strength *= 8;
    }
    const ExactAnswer strong = exact_answer_to(problem);
    expect_same(weak, strong, weak.solution.proxy - strong.solution.proxy);
  });
}

TEST(Laws, APrimitiveMayBeSplitIntoTwoHalves) {
  expect_of_all(well_conditioned, cases(10000), [&](Problem problem, std::uint64_t seed) {
    const ExactAnswer whole = exact_answer_to(problem);
    if (problem.primitives.empty()) {
      return;
    }
    Random random(seed);
    Primitive& half = problem.primitives[random.below(problem.primitives.size())];
    half.strength /= 2;
    const Primitive other = half;
    problem.primitives.push_back(other);
    const ExactAnswer halves = exact_answer_to(problem);
    expect_same(whole, halves, whole.solution.proxy - halves.solution.proxy);
  });
}

TEST(Laws, TheProxyMovesNoFasterThanTheProbe) {
  expect_of_all(all_families, cases(10000), [&](Problem problem, std::uint64_t seed) {
    const ExactAnswer before = exact_answer_to(problem);
    const Vec3 probe = problem.probe;
    Random random(seed);
    problem.probe += random.unit_vector() * random.log_uniform(1e-9, 1e-2);
    const ExactAnswer after = exact_answer_to(problem);
    const double moved = glm::length(after.solution.proxy - before.solution.proxy);
    const double probe_moved = glm::length(problem.probe - probe) * (1 + 1e-14);
    EXPECT_LE(moved, probe_moved + before.bound() + after.bound());
  });
}

TEST(Laws, AtRestTheForceIsConstantToTheLastBit) {
  expect_of_all(all_families, cases(2000, 10), [&](const Problem& problem, std::uint64_t) {
    Chain chain({.capacity = 128});
    std::vector<Vec3> forces(problem.primitives.size());
    Problem moving = problem;
    moving.probe += Vec3(1e-5, -2e-5, 0.5e-5);
    chain.solve(moving.balance(), forces);
    const Vec3 first = coupling_force(problem.balance(), chain.solve(problem.balance(), forces).proxy);
    for (int tick = 0; tick < 10; ++tick) {
      const Vec3 force = coupling_force(problem.balance(), chain.solve(problem.balance(), forces).proxy);
      ASSERT_EQ(force, first) << "tick " << tick;
    }
  });
}

/// How much work the seeded balances are: counted, so the same on every machine but for the compiler. A slip in the
/// search costs work long before it costs an answer, for the certificate has it go on. Sums of 1000 balances a family,
/// a twentieth above what was counted.
TEST(Laws, TheWorkIsWhatItWas) {
  struct Budget {
    Family family;
    std::uint64_t cold, warm;
  };
  constexpr Budget budgets[] = {
      {Family::allowed, 1008, 1005}, {Family::oblique, 1605, 1835},       {Family::co_located, 2167, 2769},
      {Family::spread, 5155, 3595},  {Family::near_parallel, 3994, 3119}, {Family::edge, 1392, 2578},
      {Family::stiff, 2442, 1964},   {Family::hard, 2352, 2029},          {Family::far_away, 2877, 2485},
      {Family::tiny, 1517, 1579},
  };
  ExactScratch scratch(128);
  for (const Budget& budget : budgets) {
    std::uint64_t cold = 0, warm = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
      Problem problem = make_problem(budget.family, seed);
      std::vector<Vec3> forces(problem.primitives.size());
      cold += static_cast<std::uint64_t>(solve_exact(problem.balance(), forces, scratch).iterations);
      Random random(seed);
      problem.probe += random.unit_vector() * 1e-5;
      warm += static_cast<std::uint64_t>(
          solve_exact(problem.balance(), forces, scratch, {.start = Start::warm}).iterations);
    }
    EXPECT_LE(20 * cold, 21 * budget.cold) << name_of(budget.family) << " cold: " << cold;
    EXPECT_LE(20 * warm, 21 * budget.warm) << name_of(budget.family) << " warm: " << warm;
  }
}

/// A directed force has no position, and a point no direction: what stands there, if only from an earlier use of the
/// memory, changes no bit of an answer, of its forces or of its certificate.
TEST(Laws, WhatAPrimitiveDoesNotHaveChangesNoBit) {
  const auto law = [](const Problem& problem, std::uint64_t seed) {
    Random random(seed);
    Problem littered = problem;
    for (Primitive& primitive : littered.primitives) {
      const Vec3 anything[] = {Vec3{nan}, Vec3{-infinity}, random.normal_vector(1e6), random.normal_vector(1e-3)};
      const Vec3& litter = anything[random.below(std::size(anything))];
      if (primitive.type == PrimitiveType::directed_force) primitive.position = litter;
      if (primitive.type == PrimitiveType::point) primitive.direction = litter;
    }
    for (const SolverType* const type : solver_types()) {
      std::vector<Vec3> forces(problem.primitives.size()), theirs(problem.primitives.size());
      const auto solve = [type](const Problem& one, std::vector<Vec3>& to) {
        const auto scratch = type->make_scratch != nullptr ? type->make_scratch(to.size()) : nullptr;
        return type->solve(one.balance(), to, scratch.get(), {.max_iterations = 20});
      };
      const Solution solution = solve(problem, forces), other = solve(littered, theirs);
      EXPECT_EQ(other.outcome, solution.outcome) << type->name;
      EXPECT_EQ(other.proxy, solution.proxy) << type->name;
      EXPECT_EQ(other.error_bound, solution.error_bound) << type->name;
      EXPECT_EQ(other.iterations, solution.iterations) << type->name;
      EXPECT_EQ(theirs, forces) << type->name;
      const Certificate certificate = certify(problem.balance(), solution.proxy, forces);
      const Certificate their_certificate = certify(littered.balance(), solution.proxy, forces);
      EXPECT_EQ(their_certificate.error_bound, certificate.error_bound) << type->name;
      EXPECT_EQ(their_certificate.backward_bound, certificate.backward_bound) << type->name;
      EXPECT_EQ(promised_accuracy(littered.balance(), solution.proxy, forces),
                promised_accuracy(problem.balance(), solution.proxy, forces))
          << type->name;
    }
  };
  expect_of_all(all_families, cases(2000), law);
  law(make_problem(Family::many, 0, 150), 0);  // so many that they are sorted
}

// Puts one thing wrong; returns what has to be said about it.
Rejection spoil(Problem& problem, Random& random) {
  const std::size_t i = random.below(problem.primitives.size());
  Primitive& primitive = problem.primitives[i];
  const bool has_position = primitive.type != PrimitiveType::directed_force;
  switch (random.below(8)) {
    case 0:
      problem.stiffness = -problem.stiffness;
      return {Rejection::whole_balance, Field::stiffness, Flaw::not_positive};
    case 1:
      problem.probe.y = random.below(2) == 0 ? nan : -infinity;
      return {Rejection::whole_balance, Field::probe, Flaw::not_finite};
    case 2:
      primitive.strength = nan;
      return {i, Field::strength, Flaw::not_finite};
    case 3:
      primitive.strength = -1e-30;
      return {i, Field::strength, Flaw::negative};
    case 4:
      primitive.position.z = has_position ? infinity : nan;
      primitive.strength = has_position ? primitive.strength : -1;
      return has_position ? Rejection{i, Field::position, Flaw::not_finite}
                          : Rejection{i, Field::strength, Flaw::negative};
    case 5:
      primitive.type = PrimitiveType::line;
      primitive.direction = Vec3{0};
      return {i, Field::direction, Flaw::zero_direction};
    case 6:
      primitive.type = PrimitiveType::plane;
      primitive.direction = {nan, 0, 0};
      return {i, Field::direction, Flaw::not_finite};
    default:
      problem.stiffness = 1e60;
      return {Rejection::whole_balance, Field::stiffness, Flaw::out_of_range};
  }
}

TEST(Laws, WhateverIsWrongIsNamed) {
  Chain chain({.capacity = 128});
  expect_of_all(all_families, cases(10000), [&](Problem problem, std::uint64_t seed) {
    if (problem.primitives.empty()) {
      return;
    }
    Random random(seed);
    const Rejection expected = spoil(problem, random);
    std::vector<Vec3> forces(problem.primitives.size());
    const Solution solution = chain.solve(problem.balance(), forces);
    ASSERT_EQ(solution.outcome, Outcome::refused);
    EXPECT_EQ(solution.rejection->primitive, expected.primitive);
    EXPECT_EQ(solution.rejection->field, expected.field);
    EXPECT_EQ(solution.rejection->flaw, expected.flaw);
  });
}

}  // namespace
}  // namespace palpate::solver
