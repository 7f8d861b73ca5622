// A program outside the tree: presses 2 mm into a wall of 10 N through the installed library, and checks the force.
#include <array>
#include <cmath>
#include <cstdio>

#include "solver/chain.h"

int main() {
  using namespace palpate::solver;
  const std::array wall{make_plane(10.0, {0, 0, 0}, {0, 1, 0})};
  const Balance balance{.stiffness = 400.0, .probe = {0, -0.002, 0}, .previous_proxy = {0, 0, 0}, .primitives = wall};
  std::array<Vec3, 1> forces{};
  Chain chain;
  const Solution solution = chain.solve(balance, forces);
  const Vec3 force = coupling_force(balance, solution.proxy);
  std::printf("force %.3f N along y, error bound %.1e m\n", force.y, solution.error_bound);
  return std::abs(force.y - 0.8) < 1e-12 ? 0 : 1;
}
