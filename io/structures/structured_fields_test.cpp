// A scan with structures: the scan's own fields, and each structure's distance at its index.
#include "io/structures/structured_fields.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "io/structures/distance_field.h"

namespace palpate::io {
namespace {

class ValueOfX final : public FieldSource {
 public:
  FieldSet available() const noexcept override { return FieldSet::value; }
  Sample sample(const Vec3& at, FieldSet wanted) const noexcept override {
    Sample sample;
    sample.inside = true;
    if (contains(wanted, FieldSet::value)) sample.value = 10 * at.x;
    return sample;
  }
};

/// A ball of 4 mm.
std::shared_ptr<const DistanceField> ball_at(double x) {
  Mask mask;
  mask.geometry.dimensions = mask.size = glm::ivec3(14);
  for (int k = 0; k < 14; ++k) mask.geometry.slice_positions.emplace_back(x - 6.5, -6.5, k - 6.5);
  for (int n = 0; n < 14 * 14 * 14; ++n) {
    const Vec3 at = mask.geometry.to_patient({n % 14, n / 14 % 14, n / 196});
    mask.occupancy.push_back(glm::distance(at, Vec3(x, 0, 0)) < 4 ? Mask::full : 0);
  }
  return distance_of(mask);
}

TEST(StructuredFields, HaveTheScanAndEachStructureInItsOrder) {
  const std::vector<std::shared_ptr<const DistanceField>> structures{ball_at(0), ball_at(20)};
  const StructuredFields fields(std::make_shared<ValueOfX>(), structures);
  for (const double x : {0.0, 3.0, 20.0, 18.0}) {
    const Vec3 at(x, 0.5, 0.2);
    const Sample all = fields.sample(at, FieldSet::value | FieldSet::distance);
    EXPECT_TRUE(all.inside);
    EXPECT_EQ(all.value, 10 * x);
    for (std::size_t n = 0; n < 2; ++n) {
      EXPECT_EQ(all.distance[n].mm, structures[n]->sample(at).mm) << n;
      EXPECT_EQ(all.distance[n].gradient, structures[n]->sample(at).gradient) << n;
    }
    EXPECT_EQ(all.distance[0].mm > 0, x < 10);
    EXPECT_EQ(all.distance[1].mm > 0, x > 10);
    EXPECT_EQ(all.distance[2].mm, 0);
    EXPECT_EQ(fields.sample(at, FieldSet::value).distance[0].mm, 0) << "what is not wanted is not read";
    EXPECT_EQ(fields.sample(at, FieldSet::distance).value, 0);
  }
}

}  // namespace
}  // namespace palpate::io
