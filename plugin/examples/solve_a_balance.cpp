// The solver alone: a probe pressed 2 mm into a wall of 10 N, beside a line that the proxy slides along.
//
// Links palpate::solver and nothing else.
#include <array>
#include <cmath>
#include <cstdio>

#include "solver/chain.h"

int main() {
  namespace solver = palpate::solver;
  // Device frame: m, N. The wall is the plane y = 0; the line runs along x, 1 mm beside the probe.
  const std::array primitives{solver::make_plane(10.0, {0, 0, 0}, {0, 1, 0}),
                              solver::make_line(0.2, {0, 0, 0.001}, {1, 0, 0})};
  const solver::Balance balance{
      .stiffness = 400.0, .probe = {0, -0.002, 0}, .previous_proxy = {0, 0, 0}, .primitives = primitives};
  std::array<solver::Vec3, 2> forces{};
  solver::Chain chain;
  const solver::Solution solution = chain.solve(balance, forces);
  const solver::Vec3 force = solver::coupling_force(balance, solution.proxy);
  std::printf("proxy   %9.6f %9.6f %9.6f m, within %.0e m\n", solution.proxy.x, solution.proxy.y, solution.proxy.z,
              solution.error_bound);
  std::printf("force   %9.6f %9.6f %9.6f N\n", force.x, force.y, force.z);
  // The wall holds the proxy at y = 0 with k times the depth. The line pulls it all its 0.2 N: k times 1 mm would be
  // 0.4 N.
  const bool right = std::abs(force.y - 0.8) < 1e-12 && std::abs(force.z - 0.2) < 1e-12;
  return right ? 0 : 1;
}
