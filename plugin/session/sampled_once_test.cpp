#include "plugin/session/sampled_once.h"

#include <gtest/gtest.h>

#include <memory>

namespace palpate::plugin {
namespace {

/// Tells how often it was sampled, and gives the place back.
class Counting final : public io::FieldSource {
 public:
  io::FieldSet available() const noexcept override { return io::FieldSet::value | io::FieldSet::gradient; }
  io::Sample sample(const io::Vec3& position_mm, io::FieldSet wanted) const noexcept override {
    ++samples;
    io::Sample sample;
    sample.inside = true;
    sample.value = position_mm.x;
    if (contains(wanted, io::FieldSet::gradient)) sample.gradient = {1, 0, 0};
    return sample;
  }
  mutable int samples = 0;
};

TEST(SampledOnce, SamplesAPlaceOnce) {
  const auto source = std::make_shared<const Counting>();
  const SampledOnce once(source);
  const io::FieldSet both = io::FieldSet::value | io::FieldSet::gradient;
  EXPECT_EQ(once.sample({1, 2, 3}, both).value, 1);
  EXPECT_EQ(once.sample({1, 2, 3}, io::FieldSet::value).value, 1);
  EXPECT_EQ(source->samples, 1);
  EXPECT_EQ(once.sample({4, 2, 3}, io::FieldSet::value).value, 4);
  EXPECT_EQ(source->samples, 2);
  EXPECT_EQ(once.sample({1, 2, 3}, io::FieldSet::value).value, 1);
  EXPECT_EQ(source->samples, 3);
}

TEST(SampledOnce, SamplesAgainForAFieldThatWasNotAskedFor) {
  const auto source = std::make_shared<const Counting>();
  const SampledOnce once(source);
  EXPECT_EQ(once.sample({1, 2, 3}, io::FieldSet::value).gradient.x, 0);
  EXPECT_EQ(once.sample({1, 2, 3}, io::FieldSet::value | io::FieldSet::gradient).gradient.x, 1);
  EXPECT_EQ(source->samples, 2);
}

}  // namespace
}  // namespace palpate::plugin
