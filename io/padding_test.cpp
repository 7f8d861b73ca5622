#include "io/padding.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace palpate::io {
namespace {

template <typename Stored>
void expect_what_the_volume_says(const std::vector<double>& ends, const std::vector<Stored>& values) {
  Volume volume;
  volume.geometry.dimensions = {static_cast<int>(values.size()), 1, 1};
  volume.voxels = values;
  for (const double first : ends) {
    for (const double second : ends) {
      volume.padding = {first, second};
      const internal::StoredPadding<Stored> padding(volume);
      for (std::size_t n = 0; n < values.size(); ++n) {
        const bool expected =
            volume.is_padding(static_cast<int>(n), 0, 0) || !std::isfinite(static_cast<double>(values[n]));
        ASSERT_EQ(padding(values[n]), expected ? 1U : 0U) << first << " ... " << second << ": " << values[n];
        ASSERT_TRUE(padding.possible() || !expected);
      }
    }
  }
  volume.padding.reset();
  for (const Stored value : values) {
    EXPECT_EQ(internal::StoredPadding<Stored>(volume)(value), std::isfinite(static_cast<double>(value)) ? 0U : 1U);
  }
}

// Ends between whole numbers, between floats, beyond what is stored, the wrong way round, and not a number.
TEST(StoredPadding, IsWhatTheVolumeCallsPaddingAndWhatIsNoNumber) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> ends{-infinity, -1e300,  -70000, -32769, -32768.5, -32768,      -2000.5, -2000,
                           -0.5,      0,       0.5,    0.1,    1,        32767,       32767.5, 32768,
                           65535,     65535.5, 65536,  3.5e38, infinity, std::nan("")};
  expect_what_the_volume_says<std::int16_t>(ends, {-32768, -32767, -2001, -2000, -1999, -1, 0, 1, 2, 32766, 32767});
  expect_what_the_volume_says<std::uint16_t>(ends, {0, 1, 2, 1999, 2000, 32767, 32768, 65534, 65535});
  std::vector<float> floats{-std::numeric_limits<float>::infinity(),
                            std::numeric_limits<float>::infinity(),
                            std::nanf(""),
                            -std::numeric_limits<float>::max(),
                            std::numeric_limits<float>::max(),
                            std::numeric_limits<float>::denorm_min(),
                            -0.0F,
                            0.0F};
  for (const double end : ends) {
    const auto near = static_cast<float>(end);
    floats.insert(floats.end(), {near, std::nextafter(near, -1e38F), std::nextafter(near, 1e38F)});
  }
  expect_what_the_volume_says<float>(ends, floats);
}

}  // namespace
}  // namespace palpate::io
