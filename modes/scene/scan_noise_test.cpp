// The noise of scans whose noise is known.
#include "modes/scene/scan_noise.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "modes/scene/faint_walls.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

constexpr double noise_sd = 20;

/// Noise about 1000 in slices from `first` on; what is below was cut off at zero, as the background of an MR is.
std::shared_ptr<const io::Volume> noisy_from(int first) {
  const testdata::Phantom even{.background = 0, .bodies = {}};
  io::Volume volume = testdata::scan(even, testdata::make_geometry({.size = glm::ivec3(64)}));
  std::mt19937_64 random(11);
  std::normal_distribution<double> grain(1000, noise_sd);
  std::vector<float> values;
  for (int k = 0; k < 64; ++k) {
    for (int n = 0; n < 64 * 64; ++n) values.push_back(k < first ? 0.0F : static_cast<float>(grain(random)));
  }
  volume.voxels = std::move(values);
  volume.slope = 1;
  volume.intercept = 0;
  return std::make_shared<const io::Volume>(std::move(volume));
}

/// Independent noise of a voxel of 1 mm, in one component of the derivative of a Gaussian of that scale, per mm.
double sd_of_gradient(double scale_mm) {
  return noise_sd / std::sqrt(16 * std::pow(std::numbers::pi, 1.5) * std::pow(scale_mm, 5));
}

TEST(ScanNoise, IsThatOfTheScanHoweverMuchBackgroundIsCutOff) {
  constexpr double scale_mm = 2;
  for (const int background : {0, 8, 24}) {
    const auto volume = noisy_from(background);
    const internal::ScanNoise noise(*volume, io::GradientKernel(volume, scale_mm), 1);
    EXPECT_NEAR(noise.spread().noise, noise_sd, 0.05 * noise_sd) << background;
    for (const std::vector<double>& limits : {std::vector<double>{}, std::vector<double>{500}}) {
      const internal::Noise body = noise.between(limits).back();
      EXPECT_NEAR(body.value, noise_sd, 0.05 * noise_sd) << background;
      EXPECT_NEAR(body.gradient, sd_of_gradient(scale_mm), 0.25 * sd_of_gradient(scale_mm)) << background;
    }
  }
}

/// Values of a scan that is not a cube, as stored.
std::shared_ptr<const io::Volume> scan_of_values(const glm::ivec3& size, std::vector<float> values,
                                                 std::optional<std::pair<double, double>> padding = {}) {
  io::Volume volume =
      testdata::scan({.background = 0, .bodies = {}}, testdata::make_geometry({.size = size}), {.quantised = false});
  volume.voxels = std::move(values);
  volume.padding = padding;
  return std::make_shared<const io::Volume>(std::move(volume));
}

/// What is padding counts nowhere: whatever is written there, the noise is the same to the last bit.
TEST(ScanNoise, DoesNotDependOnWhatIsWrittenIntoPadding) {
  constexpr double scale_mm = 1.5;
  constexpr glm::ivec3 size{40, 24, 6};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<float> grain(1000, 20);
    std::uniform_real_distribution<float> padded(-3000, -2000);
    std::vector<float> some, other;
    for (int n = 0; n < size.x * size.y * size.z; ++n) {
      const bool is_padding = n / 7 % 3 == 0 || (n / size.x) % 11 == 0;
      some.push_back(is_padding ? padded(random) : grain(random));
      other.push_back(is_padding ? padded(random) : some.back());
    }
    const std::array both{scan_of_values(size, some, std::pair{-3000.0, -2000.0}),
                          scan_of_values(size, other, std::pair{-3000.0, -2000.0})};
    const internal::ScanNoise noise(*both[0], io::GradientKernel(both[0], scale_mm), 1);
    const internal::ScanNoise again(*both[1], io::GradientKernel(both[1], scale_mm), 1);
    EXPECT_GT(noise.spread().low, 900);
    EXPECT_LT(noise.spread().high, 1100);
    EXPECT_EQ(noise.spread().low, again.spread().low);
    EXPECT_EQ(noise.spread().high, again.spread().high);
    EXPECT_EQ(noise.spread().noise, again.spread().noise);
    EXPECT_EQ(noise.between({}).front().value, again.between({}).front().value);
    EXPECT_EQ(noise.between({}).front().gradient, again.between({}).front().gradient);
  }
}

/// A tissue of one value has no gradient, also where steps and voxels without a number lie beside it.
TEST(ScanNoise, IsNoneWhereMostOfATissueIsOfOneValue) {
  constexpr double scale_mm = 1.5;
  constexpr glm::ivec3 size{30, 20, 24};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<float> grain(-500, 20);
    std::uniform_int_distribution<int> where(0, size.x * size.y * size.z - 1);
    std::vector<float> values;
    for (int n = 0; n < size.x * size.y * size.z; ++n) {
      values.push_back(n < size.x * size.y * 12 ? grain(random) : 0);
    }
    for (int n = 0; n < 20; ++n) values[static_cast<std::size_t>(where(random))] = std::nanf("");
    const auto volume = scan_of_values(size, values);
    const internal::ScanNoise noise(*volume, io::GradientKernel(volume, scale_mm), 1);
    const std::vector<double> limits{-250};
    EXPECT_EQ(noise.between(limits)[1].gradient, 0) << seed;
    EXPECT_EQ(noise.between(limits)[1].value, 0) << seed;
    EXPECT_GT(noise.between(limits)[0].gradient, 0.5 * sd_of_gradient(scale_mm)) << seed;
  }
}

/// Without noise: a part of the gradient of a step of 3.5 bandwidths, each of half a percent of the range. So it is as
/// many times larger as all values are, and the same from whatever value they are counted.
TEST(FaintWalls, AreAsSteepAsThreeAndAHalfBandwidthsOrMore) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> exponent(-2, 3), shift(-1000, 1000);
  constexpr glm::ivec3 size{24, 20, 24};
  for (int n = 0; n < 5; ++n) {
    const double range = std::pow(10, exponent(random)), low = shift(random), scale_mm = n % 2 == 0 ? 1.5 : 2.5;
    std::vector<float> values;
    for (int voxel = 0; voxel < size.x * size.y * size.z; ++voxel) {
      values.push_back(static_cast<float>(voxel < size.x * size.y * 8 ? low : low + range));
    }
    const auto volume = scan_of_values(size, values);
    const internal::ScanNoise noise(*volume, io::GradientKernel(volume, scale_mm), 1);
    const double steepest = 3.5 * 0.005 * range / (scale_mm * std::sqrt(2 * std::numbers::pi));
    EXPECT_NEAR(internal::least_gradient_of_walls(noise, scale_mm), 0.3 * steepest, 0.01 * steepest) << range;
  }
}

}  // namespace
}  // namespace palpate::modes
