#include "palpate/solver/exact.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace palpate::solver {
namespace {

TEST(Exact, SolvesWhereFrictionIsAboutToSlip) {
  const Vec3 at{0.0056593669516060239, 0.0013211055795581451, -0.00081163062015960773};
  const std::array rest{make_plane(1, at, {0.11200159154212248, 0.54581415208091721, 0.83038699103503599}),
                        make_point(0.1, at)};
  std::array<Vec3, 2> forces;
  ExactScratch scratch;
  const Balance balance{400, {0.00564, 0, -0.00282}, at, rest};
  const Solution solution = solve_exact(balance, forces, scratch);
  EXPECT_EQ(solution.outcome, Outcome::solved) << solution.iterations;
  EXPECT_LT(solution.error_bound, 1e-14);
}

}  // namespace
}  // namespace palpate::solver
