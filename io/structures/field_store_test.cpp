// The bricks that are stored again after a change, and those beside them.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "io/structures/field_patch.h"
#include "io/testing/made_labels.h"

namespace palpate::io::internal {
namespace {

/// A field and a box of bricks around all of it, none of which is measured again yet.
struct PatchedField {
  std::shared_ptr<const DistanceField> field;
  FieldChange change;
  Patch patch;

  PatchedField(std::shared_ptr<const DistanceField> before, double extent_mm)
      : field(std::move(before)),
        change{.where = {{Vec3(0), Vec3(0)}}, .touched_mm = 1, .within_mm = extent_mm, .after = {}, .bumps = {}},
        patch(patch_around(field->parts(), change, field->parts().kept_within_mm())) {}

  /// Places of the box that have neighbors on all sides in it, with a brick of the field or beside one.
  std::vector<glm::ivec3> places(bool with_brick) const {
    std::vector<glm::ivec3> found;
    const glm::ivec3& size = patch.bricks.lattice.bricks;
    for (int z = 1; z + 1 < size.z; ++z) {
      for (int y = 1; y + 1 < size.y; ++y) {
        for (int x = 1; x + 1 < size.x; ++x) {
          const glm::ivec3 place(x, y, z);
          bool beside = false;
          for (int n = 0; n < 27; ++n) {
            beside = beside || patch.stored(place + glm::ivec3(n % 3, n / 3 % 3, n / 9) - 1) != nullptr;
          }
          if (beside && (patch.stored(place) != nullptr) == with_brick) found.push_back(place);
        }
      }
    }
    return found;
  }

  /// Measures a brick again: each distance becomes a quarter of what it was.
  void measure(const glm::ivec3& place) {
    std::int32_t& slot = patch.bricks.slot[patch.box_at(place)];
    if (slot >= 0) return;
    slot = static_cast<std::int32_t>(patch.bricks.count());
    patch.bricks.place.push_back(place);
    const float* stored = patch.stored(place);
    for (int k = 0; k < brick_edge; ++k) {
      for (int j = 0; j < brick_edge; ++j) {
        for (int i = 0; i < brick_edge; ++i) {
          const Vec3 at = patch.bricks.lattice.position(Vec3(place * brick_edge + glm::ivec3(i, j, k)));
          const float mm =
              stored != nullptr ? stored[stored_at(i, j, k)] : static_cast<float>(field->parts().sample_far(at).mm);
          patch.before_mm.push_back(mm);
          patch.f.push_back(mm);
          patch.mm.push_back(0.25F * mm);
          patch.closest.emplace_back(nowhere);
        }
      }
    }
  }
};

// Beside a measured brick the others read its nodes, whether the field had it before or not, and however few there are.
TEST(FieldStore, WhatWasMeasuredIsWhatTheStoredFieldGives) {
  std::mt19937 random(12);
  DistanceOptions near;
  near.reach_mm = 3;
  for (const Vec3& spacing : {Vec3(1), Vec3(0.8, 1.1, 1.5)}) {
    const auto egg = [](const Vec3& at) { return glm::length(at / Vec3(14, 9, 11)) < 1; };
    const auto field = distance_of(made_labels(egg, 20, {.spacing = spacing}), near);
    const PatchedField none(field, 24);
    const std::vector<glm::ivec3> old = none.places(true), fresh = none.places(false);
    ASSERT_GT(old.size(), 20U);
    ASSERT_GT(fresh.size(), 20U);
    std::size_t asked = 0, in_fresh = 0;
    for (int trial = 0; trial < 30; ++trial) {
      PatchedField one(field, 24);
      for (int n = 0; n <= trial % 3; ++n) {
        const std::vector<glm::ivec3>& some = trial % 2 == 0 ? old : fresh;
        one.measure(some[random() % some.size()]);
      }
      const DistanceParts parts = stored(one.patch, 1);
      for (const glm::ivec3& place : one.patch.bricks.place) {
        std::uniform_real_distribution<double> nodes(-3, brick_edge + 2);
        for (int n = 0; n < 300; ++n) {
          const double i = nodes(random), j = nodes(random), k = nodes(random);
          const Vec3 at = one.patch.bricks.lattice.position(Vec3(place * brick_edge) + Vec3(i, j, k));
          Distance there;
          if (!parts.sample_near(at, there)) continue;
          ++asked;
          Distance before;
          in_fresh += field->parts().sample_near(at, before) ? 0 : 1;
          EXPECT_NEAR(measured_at(one.patch, at), there.mm, 1e-6) << trial << ": node " << i << ' ' << j << ' ' << k;
        }
      }
    }
    EXPECT_GT(asked, 3000U);
    EXPECT_GT(in_fresh, 300U) << "where the field had no brick";
  }
}

}  // namespace
}  // namespace palpate::io::internal
