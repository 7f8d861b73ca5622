#include "solver/exact/walk.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <vector>

#include "solver/testing/problems.h"
#include "solver/testing/values.h"

namespace palpate::solver::internal {
namespace {

/// A walk that begins at the probe with nothing locked.
struct Outing {
  Outing(const std::vector<Primitive>& primitives, double stiffness)
      : placed(primitives.size()), forces(placed.size()), hold(placed.size()), met(placed.size()) {
    for (std::size_t i = 0; i < placed.size(); ++i) place(primitives[i], o, placed[i]);
    walk.primitives = placed;
    walk.stiffness = stiffness;
    walk.coarseness = 0x1p-51;
    walk.forces = forces;
    walk.hold = hold;
    walk.met = met;
    walk.z = fine(o);
  }
  std::vector<Placed> placed;
  std::vector<Vec3> forces;
  std::vector<ForceRegion> hold;
  std::vector<std::uint32_t> met;
  Walk walk;
};

struct Case {
  std::vector<Primitive> primitives = {};
  Vec3 proxy{0};  ///< m, relative to the probe
  int looks = 0;  ///< at least
};

/// One to three planes at right angles, a line or a point, each strong enough to hold the proxy at its distance from
/// the probe.
Case any_case(Random& random, double stiffness, std::size_t kind, bool is_turned) {
  std::array<Vec3, 3> axes{x, y, z};
  if (is_turned) {
    axes[0] = random.unit_vector();
    axes[1] = glm::normalize(glm::cross(axes[0], random.unit_vector()));
    axes[2] = glm::cross(axes[0], axes[1]);
  }
  const auto strength_at = [&](double distance) { return stiffness * distance / random.uniform(0.1, 0.9); };
  const double distance = random.log_uniform(1e-5, 1e-1);
  if (kind == 0) return {{make_point(strength_at(distance), distance * axes[0])}, distance * axes[0], 4};
  if (kind == 1) return {{make_line(strength_at(distance), distance * axes[0], axes[1])}, distance * axes[0], 4};
  Case planes{.looks = 1};
  for (std::size_t n = 0; n + 1 < kind; ++n) {
    const double depth = distance * random.uniform(0.5, 2);
    planes.primitives.push_back(make_plane(strength_at(depth), depth * axes[n], axes[n]));
    planes.proxy += depth * axes[n];
    planes.looks += 2;
  }
  return planes;
}

/// Each is locked on a way of its own. The energy is looked at where the walk begins, where each way would end, and on
/// each plane that is locked; for a line or point before and after it is locked. None of these looks is left out, and a
/// walk that is capped earlier tells its cap.
TEST(Walk, TellsEveryLook) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    const double stiffness = random.log_uniform(50, 5000);
    const std::size_t kind = seed % 5;
    const Case one = any_case(random, stiffness, kind, seed % 2 == 1);
    Outing whole(one.primitives, stiffness);
    EXPECT_GE(descend(whole.walk, 400), one.looks) << kind << ", " << seed;
    EXPECT_TRUE(whole.walk.arrived) << kind << ", " << seed;
    EXPECT_EQ(whole.walk.active.count, static_cast<int>(one.primitives.size())) << kind << ", " << seed;
    EXPECT_LT(glm::distance(whole.walk.z.hi(), one.proxy), 1e-13 * glm::length(one.proxy)) << kind << ", " << seed;
    for (const int cap : {1, 2}) {
      Outing cut(one.primitives, stiffness);
      EXPECT_EQ(descend(cut.walk, cap), cap) << kind << ", " << seed;
      EXPECT_FALSE(cut.walk.arrived) << kind << ", " << seed;
    }
  }
}

}  // namespace
}  // namespace palpate::solver::internal
