// The noise of scans whose noise is known.
#include "modes/scene/scan_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

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

}  // namespace
}  // namespace palpate::modes
