/// What a chain remembers changes no answer: a balance that differs from the last one in anything is solved anew.

#include <gtest/gtest.h>
#include <malloc.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "solver/analytical.h"
#include "solver/certify.h"
#include "solver/chain.h"
#include "solver/descent.h"
#include "solver/exact.h"
#include "solver/testing/problems.h"
#include "solver/testing/values.h"

namespace palpate::solver {
namespace {

const ChainOptions descent_alone{.solvers = {&descent_solver}, .max_iterations = 40};
const ChainOptions exact_alone{.solvers = {&exact_solver}};

struct ChainAnswer {
  Solution solution;
  std::vector<Vec3> forces;
};

ChainAnswer answer_of(Chain& chain, const Balance& balance) {
  ChainAnswer answer{{}, std::vector<Vec3>(balance.primitives.size(), Vec3{-77, 77, -77})};
  answer.solution = chain.solve(balance, answer.forces);
  return answer;
}

/// An oblique balance that every kind of primitive has a part in.
struct EachKind {
  std::vector<Primitive> primitives{make_plane(2, {0, 1e-3, 0}, {0.6, 0.8, 0}), make_plane(3, Vec3{0}, {0, 0.8, 0.6}),
                                    make_line(0.3, {2e-3, 0, 0}, {0.36, 0.48, 0.8}), make_point(0.2, {0, 0, -3e-3}),
                                    make_directed_force(0.4, {1, 0, 0})};
  double stiffness = 400;
  Vec3 probe{1e-3, -4e-3, 2e-3};
  Vec3 previous_proxy{1e-3, 0, 0};

  Balance balance() const { return {stiffness, probe, previous_proxy, primitives}; }
};

const std::vector<std::function<void(EachKind&)>> changes{
    [](EachKind& e) { e.stiffness = 500; },
    [](EachKind& e) { e.probe.x += 1e-3; },
    [](EachKind& e) { e.probe.y += 1e-3; },
    [](EachKind& e) { e.probe.z += 1e-3; },
    [](EachKind& e) { e.primitives[0].strength = 1; },
    [](EachKind& e) { e.primitives[1].position.y = 1e-3; },
    [](EachKind& e) {
      e.primitives[2].direction = {0, 0, 1};
    },
    [](EachKind& e) {
      e.primitives[3].type = PrimitiveType::line, e.primitives[3].direction = {1, 0, 0};
    },
    [](EachKind& e) {
      e.primitives[4].direction = {0, -1, 0};
    },
    [](EachKind& e) { e.primitives.pop_back(); },
    [](EachKind& e) {
      e.primitives.push_back(make_directed_force(0.5, {0, 0, 1}));
    },
    [](EachKind& e) { std::swap(e.primitives[0], e.primitives[2]); },
};

TEST(ChainLaws, ABalanceThatChangedInAnythingIsSolvedAnew) {
  for (const ChainOptions& options : {ChainOptions{}, descent_alone}) {
    for (std::size_t n = 0; n < changes.size(); ++n) {
      EachKind scene;
      Chain chain(options);
      const ChainAnswer before = answer_of(chain, scene.balance());
      changes[n](scene);
      const ChainAnswer after = answer_of(chain, scene.balance());
      Chain fresh(options);
      const ChainAnswer anew = answer_of(fresh, scene.balance());
      const double alike =
          options.solvers.contains(descent_solver) ? 0 : after.solution.error_bound + anew.solution.error_bound;
      EXPECT_LE(glm::distance(after.solution.proxy, anew.solution.proxy), alike) << "change " << n;
      ASSERT_EQ(after.forces.size(), anew.forces.size());
      for (std::size_t i = 0; i < anew.forces.size(); ++i) {
        EXPECT_LT(glm::distance(after.forces[i], anew.forces[i]), 1e-9) << "change " << n << ", force " << i;
      }
      // The change is one that can be told.
      const bool same = after.solution.proxy == before.solution.proxy && after.forces == before.forces;
      EXPECT_FALSE(same) << "change " << n;
    }
  }
}

TEST(ChainLaws, TheSameBalanceHasTheSameAnswerWithAllOfItsForces) {
  EachKind scene;
  Chain chain;
  const ChainAnswer first = answer_of(chain, scene.balance());
  ASSERT_EQ(first.solution.outcome, Outcome::solved);
  scene.previous_proxy += Vec3{1e-3, 0, 0};  // which no solver but descent reads
  const ChainAnswer again = answer_of(chain, scene.balance());
  EXPECT_EQ(again.forces, first.forces);
  EXPECT_EQ(again.solution.proxy, first.solution.proxy);
  EXPECT_EQ(again.solution.error_bound, first.solution.error_bound);
  EXPECT_EQ(again.solution.iterations, first.solution.iterations);
  EXPECT_EQ(again.solution.solver, first.solution.solver);
}

TEST(ChainLaws, DescentStartsAnewFromAnotherPreviousProxy) {
  EachKind scene;
  scene.primitives.resize(1);
  ChainOptions options = descent_alone;
  options.max_iterations = 0;
  Chain chain(options);
  ASSERT_EQ(answer_of(chain, scene.balance()).solution.outcome, Outcome::solved);
  scene.previous_proxy += Vec3{7e-4, 5e-4, 3e-4};
  Chain fresh(options);
  const ChainAnswer after = answer_of(chain, scene.balance()), anew = answer_of(fresh, scene.balance());
  EXPECT_EQ(after.solution.proxy, anew.solution.proxy);
  EXPECT_EQ(after.solution.iterations, anew.solution.iterations);
}

/// A refusal is not an answer to be repeated, nor are the forces before it a start.
TEST(ChainLaws, AfterARefusalOfTheSolversTheNextBalanceStartsCold) {
  EachKind apart;
  apart.primitives[2] = make_point(infinity, Vec3{0});
  apart.primitives[3] = make_point(infinity, {1e-3, 0, 0});
  const EachKind scene;
  Chain chain;
  answer_of(chain, scene.balance());
  ASSERT_EQ(answer_of(chain, apart.balance()).solution.outcome, Outcome::refused);
  const ChainAnswer after = answer_of(chain, scene.balance());
  Chain fresh;
  const ChainAnswer anew = answer_of(fresh, scene.balance());
  EXPECT_EQ(after.solution.proxy, anew.solution.proxy);
  EXPECT_EQ(after.forces, anew.forces);
  EXPECT_EQ(after.solution.iterations, anew.solution.iterations);
}

TEST(ChainLaws, ForgottenItIsAsFresh) {
  const EachKind scene;
  EachKind other;
  other.probe *= 3.0;
  Chain chain, fresh;
  answer_of(chain, other.balance());
  chain.forget();
  const ChainAnswer after = answer_of(chain, scene.balance()), anew = answer_of(fresh, scene.balance());
  EXPECT_EQ(after.solution.proxy, anew.solution.proxy);
  EXPECT_EQ(after.forces, anew.forces);
  EXPECT_EQ(after.solution.iterations, anew.solution.iterations);
}

/// Whatever was solved before, the same balance included.
TEST(ChainLaws, ForgottenItIsAsFreshForEveryBalance) {
  for (const Family family : all_families) {
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
      const Problem problem = make_problem(family, seed);
      Chain chain(exact_alone), fresh(exact_alone);
      answer_of(chain, problem.balance());
      chain.forget();
      const ChainAnswer after = answer_of(chain, problem.balance()), anew = answer_of(fresh, problem.balance());
      EXPECT_EQ(after.solution.proxy, anew.solution.proxy) << name_of(family) << " " << seed;
      EXPECT_EQ(after.solution.iterations, anew.solution.iterations) << name_of(family) << " " << seed;
      EXPECT_EQ(after.forces, anew.forces) << name_of(family) << " " << seed;
    }
  }
}

TEST(ChainLaws, WithoutAWarmStartNothingIsRemembered) {
  const EachKind scene;
  EachKind other;
  other.probe *= 3.0;
  Chain chain({.warm_start = false}), fresh({.warm_start = false});
  answer_of(chain, other.balance());
  const ChainAnswer after = answer_of(chain, scene.balance()), anew = answer_of(fresh, scene.balance());
  EXPECT_EQ(after.solution.proxy, anew.solution.proxy);
  EXPECT_EQ(after.forces, anew.forces);
  EXPECT_EQ(after.solution.iterations, anew.solution.iterations);
}

/// What it is remembered for: the probe moves little from tick to tick.
TEST(ChainLaws, AWarmStartSparesIterations) {
  EachKind scene;
  Chain warm(exact_alone), cold({.solvers = exact_alone.solvers, .warm_start = false});
  int warm_iterations = 0, cold_iterations = 0;
  for (int tick = 0; tick < 100; ++tick) {
    scene.probe += Vec3{2e-5, 1e-5, -1e-5};
    const ChainAnswer a = answer_of(warm, scene.balance()), b = answer_of(cold, scene.balance());
    ASSERT_EQ(a.solution.outcome, Outcome::solved);
    EXPECT_LE(glm::distance(a.solution.proxy, b.solution.proxy), a.solution.error_bound + b.solution.error_bound);
    warm_iterations += a.solution.iterations;
    cold_iterations += b.solution.iterations;
  }
  EXPECT_LT(warm_iterations, cold_iterations);
}

/// Whichever solvers are on: what is given for an answer is as near to the exact proxy as its bound says, also where
/// there are more places of constraints than the analytical solver has room for.
TEST(ChainLaws, NoAnswerIsFartherFromTheProxyThanItsBound) {
  int answers = 0, others = 0;
  for (const Family family : all_families) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      const Problem problem = make_problem(family, seed, seed % 3 == 0 ? 10 + seed : 0);
      std::vector<Vec3> forces(problem.primitives.size());
      ExactScratch scratch(forces.size());
      const Solution exact = solve_exact(problem.balance(), forces, scratch);
      if (exact.outcome != Outcome::solved) continue;
      for (const ChainOptions& options : {ChainOptions{.solvers = {&analytical_solver}}, exact_alone, ChainOptions{}}) {
        Chain chain(options);
        const Solution solution = answer_of(chain, problem.balance()).solution;
        if (solution.outcome != Outcome::solved && solution.outcome != Outcome::capped) {
          ++others;
          continue;
        }
        ++answers;
        EXPECT_LE(glm::distance(solution.proxy, exact.proxy), solution.error_bound + exact.error_bound)
            << name_of(family) << " " << seed;
      }
    }
  }
  EXPECT_GT(answers, 600);
  EXPECT_GT(others, 100) << "the analytical solver alone cannot solve all of them";
}

/// Few balances need many iterations. Of those, a chain with a cap of one gives the answer that the exact solver gives
/// with that cap.
TEST(ChainLaws, TheExactSolverKeepsToTheCapThatIsSet) {
  int met = 0;
  for (const Family family : {Family::near_parallel, Family::tiny, Family::many}) {
    for (std::uint64_t seed = 0; seed < 600; ++seed) {
      const Problem problem = make_problem(family, seed);
      const auto alone = [&problem](int cap) {
        ChainAnswer answer{{}, std::vector<Vec3>(problem.primitives.size())};
        ExactScratch scratch(problem.primitives.size());
        answer.solution = solve_exact(problem.balance(), answer.forces, scratch, {.max_iterations = cap});
        return answer;
      };
      const ChainAnswer whole = alone(400), cut = alone(1);
      if (cut.solution.iterations == whole.solution.iterations) continue;
      ++met;
      Chain chain({.solvers = exact_alone.solvers, .max_iterations = 1});
      const ChainAnswer answer = answer_of(chain, problem.balance());
      EXPECT_EQ(answer.solution.iterations, cut.solution.iterations) << name_of(family) << " " << seed;
      EXPECT_EQ(answer.solution.outcome, cut.solution.outcome) << name_of(family) << " " << seed;
      EXPECT_EQ(answer.solution.proxy, cut.solution.proxy) << name_of(family) << " " << seed;
      EXPECT_EQ(answer.forces, cut.forces) << name_of(family) << " " << seed;
      Chain without({.solvers = exact_alone.solvers});
      EXPECT_EQ(answer_of(without, problem.balance()).solution.iterations, whole.solution.iterations) << "its own cap";
    }
  }
  EXPECT_GE(met, 10) << "else no cap was met";
}

/// What is told is what the heap gives, wherever the heap tells.
TEST(ChainLaws, TheMemoryOfTheExactSolverIsWhatItTakes) {
  const auto taken = [] { return static_cast<double>(mallinfo2().uordblks + mallinfo2().hblkhd); };
  for (const std::size_t capacity : {1000U, 30000U}) {
    const double before = taken();
    const ExactScratch scratch(capacity);
    const double bytes = taken() - before;
    if (bytes == 0) GTEST_SKIP() << "this heap does not tell";
    EXPECT_NEAR(static_cast<double>(scratch.memory_bytes()), bytes, 0.01 * bytes + 4096) << capacity;
  }
}

TEST(ChainLaws, ItsMemoryIsThatOfItsCapacity) {
  const auto bytes = [](std::size_t capacity, const SolverSet& solvers) {
    return Chain({.solvers = solvers, .capacity = capacity}).memory_bytes();
  };
  const SolverSet without_scratch{&analytical_solver}, with_scratch{&exact_solver};
  EXPECT_EQ(bytes(64, without_scratch) - bytes(0, without_scratch), 64 * (sizeof(Vec3) + sizeof(Primitive)));
  EXPECT_EQ(bytes(64, with_scratch) - bytes(64, without_scratch), ExactScratch(64).memory_bytes());
}

/// 16 units in the last place of the largest length that has a part, and of the way that the forces make.
TEST(ChainLaws, ThePromiseGrowsWithTheLargestLengthAndTheForces) {
  const std::array primitives{make_point(5, {0, -30, 0}), make_directed_force(9, {1, 0, 0}), make_point(5, {0, 0, 70})};
  constexpr double ulp = 0x1p-52;
  const auto promise = [&](const Vec3& probe, const Vec3& proxy, const std::array<Vec3, 3>& forces) {
    return (promised_accuracy({250, probe, Vec3{900, 0, 0}, primitives}, proxy, forces) - 1e-14) / (16 * ulp);
  };
  const Vec3 none{0};
  EXPECT_NEAR(promise({2, 0, 0}, {0, 3, 0}, {none, none, none}), 3, 1e-12);
  EXPECT_NEAR(promise({0, 4, 0}, {0, 3, 0}, {none, none, none}), 4, 1e-12);
  EXPECT_NEAR(promise({2, 0, 0}, {0, 3, 0}, {Vec3{3, 0, 4}, none, none}), 30 + 5.0 / 250, 1e-12);
  EXPECT_NEAR(promise({2, 0, 0}, {0, 3, 0}, {Vec3{3, 0, 4}, Vec3{0, 9, 0}, none}), 30 + 14.0 / 250, 1e-12);
  EXPECT_NEAR(promise({2, 0, 0}, {0, 3, 0}, {none, Vec3{0, 9, 0}, none}), 3 + 9.0 / 250, 1e-12);
  EXPECT_NEAR(promise({2, 0, 0}, {0, 3, 0}, {Vec3{1, 0, 0}, none, Vec3{0, 0, 1}}), 70 + 2.0 / 250, 1e-12);
  EXPECT_EQ(promised_accuracy({250, none, none, {}}, none, {}), 1e-14);
}

}  // namespace
}  // namespace palpate::solver
