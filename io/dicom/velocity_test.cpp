#include "io/dicom/velocity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

using ::testing::SizeIs;

// Enhanced phase contrast: magnitude and three directions in one file, frame by frame.
TEST(Velocity, OfAnEnhancedFileIsJoined) {
  const TestFolder folder;
  std::vector<double> heights;
  for (int n = 0; n < 12; ++n) heights.push_back(2.0 * (n % 3));
  TestImage image;
  image.columns = 4;
  image.rows = 3;
  image.value = [](int i, int) { return 2048 + 100 * i; };
  image.edit = [&](DcmDataset& d) {
    put(d, DCM_BitsStored, 12);
    put(d, DCM_HighBit, 11);
    repeat_pixels(d, heights.size());
    make_multi_frame(d, heights, [&](std::size_t n, DcmItem& frame) {
      const bool magnitude = n < 3;
      DcmItem& type = group(frame, DCM_MRImageFrameTypeSequence);
      succeed(type.putAndInsertString(DCM_ComplexImageComponent, magnitude ? "MAGNITUDE" : "PHASE"));
      if (magnitude) return;
      DcmItem& velocity = group(frame, DCM_MRVelocityEncodingSequence);
      std::array<double, 3> along{};
      along[n / 3 - 1] = 1;
      succeed(velocity.putAndInsertFloat64Array(DCM_VelocityEncodingDirection, along.data(), 3));
      succeed(velocity.putAndInsertFloat64(DCM_VelocityEncodingMaximumValue, 150));
    });
  };
  write(image, folder / "enhanced");
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(1));
  EXPECT_EQ(found.series[0].frames_per_position, 4);
  ASSERT_THAT(found.velocity_fields, SizeIs(1));
  const Volume volume = load(found.velocity_fields[0]);
  ASSERT_TRUE(volume.vectors);
  for (int i = 0; i < 4; ++i) {
    const double speed = 1.5 * 100 * i / 2048;  // of 1.5 m/s at full range
    for (const auto& component : volume.vectors->along) EXPECT_NEAR(component->value_at(i, 1, 1), speed, 1e-12);
    EXPECT_NEAR(volume.value_at(i, 1, 1), std::sqrt(3.0) * speed, 1e-6);
  }
}

TEST(Velocity, NamedByTheSequenceIsJoined) {
  const TestFolder folder;
  constexpr std::array names{"*fl3d1_v80rl", "*fl3d1_v80ap", "*fl3d1_v80hf"};  // the last against the z axis
  for (std::size_t n = 0; n < names.size(); ++n) {
    std::filesystem::create_directory(folder / names[n]);
    write_stack(folder / names[n], 3, [&](int, TestImage& image) {
      image.series = "1.2.3." + std::to_string(n + 1);
      image.value = [](int, int) { return 49152; };  // half of the range above its middle
      image.edit = [&](DcmDataset& d) { put(d, DCM_SequenceName, names[n]); };
    });
  }
  const Catalogue found = find_in(folder);
  EXPECT_THAT(found.series, SizeIs(3));
  ASSERT_THAT(found.velocity_fields, SizeIs(1));
  // What cannot be known from public documents is said: once of the field, and of each series.
  EXPECT_THAT(found.velocity_fields[0].warnings, ::testing::Contains(::testing::HasSubstr("may be reversed")).Times(1));
  for (const Series& series : found.series) {
    EXPECT_THAT(series.warnings, ::testing::Contains(::testing::HasSubstr("may be reversed")));
  }
  const VectorComponents vectors = *load(found.velocity_fields[0]).vectors;
  Vec3 along;
  for (int n = 0; n < 3; ++n) along[n] = vectors.along[static_cast<std::size_t>(n)]->value_at(2, 2, 1);
  EXPECT_LT(glm::length(vectors.to_patient * along - Vec3(0.4, 0.4, -0.4)), 1e-12);
}

}  // namespace
}  // namespace palpate::io::internal
