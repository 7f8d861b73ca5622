#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/fields/volume_fields.h"
#include "modes/scene/felt_strength.h"
#include "solver/text/testing/not_finite.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

constexpr double scale_mm = 2;

/// Air, soft tissue and bone in a ball, in rows longer than what is added up at once.
std::vector<std::shared_ptr<const io::Volume>> balls() {
  testdata::Phantom phantom = testdata::make_sphere(9);
  phantom.bodies.push_back(testdata::make_sphere(4.5, testdata::bone_hu).bodies.front());
  const testdata::Grid straight{.size = {140, 8, 7}, .spacing = {0.25, 2, 2.5}};
  testdata::Grid uneven = rotated(straight, {1, 2, 3}, 40);
  uneven.tilt_degrees = 15;
  uneven.uneven_mm = 0.4;
  std::vector<std::shared_ptr<const io::Volume>> made;
  made.push_back(std::make_shared<io::Volume>(testdata::scan(phantom, make_geometry(uneven), {.noise = 40})));
  made.push_back(std::make_shared<io::Volume>(
      testdata::scan(phantom, make_geometry(straight), {.noise = 40, .circle_radius = 8})));
  io::Volume floats = testdata::scan(phantom, make_geometry(straight), {.noise = 40, .quantised = false});
  std::get<std::vector<float>>(floats.voxels)[floats.offset(70, 4, 3)] = std::numeric_limits<float>::quiet_NaN();
  made.push_back(std::make_shared<io::Volume>(std::move(floats)));
  return made;
}

class RandomScene {
 public:
  explicit RandomScene(unsigned seed) : random_(seed) {}

  Scene operator()() {
    Scene scene;
    scene.name = "random";
    scene.sampling.value = chance(0.5) ? io::ValueMethod::cubic : io::ValueMethod::trilinear;
    const double first = between(-800, -300), second = between(200, 700);
    scene.tissues = {{"air", -infinity, first, between(0, 200)},
                     {"soft", first, second, between(0, 200)},
                     {"bone", second, infinity, between(0, 200)}};
    const int count = std::uniform_int_distribution(1, 5)(random_);
    for (int n = 0; n < count; ++n) scene.modes.push_back(mode(n));
    scene.modes.push_back(mode(count));
    pair(scene.modes.back());
    return scene;
  }

 private:
  double between(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  bool chance(double of) { return between(0, 1) < of; }

  void pair(Mode& mode) {
    const std::string names[] = {"air", "soft", "bone"};
    const int from = std::uniform_int_distribution(0, 2)(random_);
    mode.from = names[from];
    mode.to = names[(from + std::uniform_int_distribution(1, 2)(random_)) % 3];
  }

  /// Zero on one side or at both ends, now and then nowhere, or the same everywhere.
  TransferFunction function(Datum of, double most) {
    const bool of_gradient = of == Datum::gradient_magnitude;
    const double from = of_gradient ? between(0, 150) : between(-1000, 600);
    const double to = from + (of_gradient ? between(1, 150) : between(1, 800));
    const auto interpolation = chance(0.5) ? Interpolation::linear : Interpolation::monotone_cubic;
    if (chance(0.1)) return TransferFunction(most);
    if (chance(0.2)) return TransferFunction({{from, 0.3 * most}, {to, most}}, interpolation);
    if (chance(0.3)) return TransferFunction({{from, most}, {to, 0}}, interpolation);
    if (chance(0.3)) return TransferFunction({{from, 0}, {0.5 * (from + to), most}, {to, 0}}, interpolation);
    return TransferFunction({{from, 0}, {to, most}}, interpolation);
  }

  Mode mode(int n) {
    constexpr Datum data[] = {Datum::gradient_magnitude, Datum::value, Datum::low, Datum::high};
    const auto datum = [&] { return data[std::uniform_int_distribution(0, 3)(random_)]; };
    Mode mode;
    mode.type = "surface";
    mode.name = "mode " + std::to_string(n);
    mode.strength_of = chance(0.7) ? Datum::gradient_magnitude : datum();
    mode.strength_n = function(mode.strength_of, between(0.1, 3));
    for (int gates = std::uniform_int_distribution(0, 3)(random_); gates > 0; --gates) {
      const Datum of = datum();
      mode.gates.push_back({of, function(of, between(0.1, 1))});
    }
    if (chance(0.6)) pair(mode);
    return mode;
  }

  std::mt19937_64 random_;
};

/// Each voxel for itself, as a tick samples it.
std::vector<float> felt_one_by_one(const std::shared_ptr<const io::Volume>& volume, const Scene& scene,
                                   const std::vector<const ActiveMode*>& modes) {
  io::FieldSet wanted = io::FieldSet::value;
  for (const ActiveMode* mode : modes) wanted = wanted | mode->strength.reads();
  const io::VolumeFields fields(volume, wanted, scale_mm, {.value = scene.sampling.value, .brick_bytes = 0});
  const glm::ivec3 size = volume->geometry.dimensions;
  std::vector<float> felt;
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        const io::Sample sample = fields.sample(volume->geometry.to_patient({i, j, k}), wanted);
        double sum = 0;
        for (const ActiveMode* mode : modes) sum += sample.inside ? mode->strength(sample) : 0;
        felt.push_back(static_cast<float>(sum));
      }
    }
  }
  return felt;
}

std::vector<float> felt_by_rows(const io::Volume& volume, const Scene& scene,
                                const std::vector<const ActiveMode*>& modes, std::span<const glm::vec3> gradients) {
  const FeltStrength strength(volume, modes, scene.sampling.value, scale_mm);
  const glm::ivec3 size = volume.geometry.dimensions;
  std::vector<float> felt(gradients.size(), -1.0F);
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      // In two pieces, cut at all places.
      const int cut = (37 * j + 11 * k) % size.x;
      for (const auto& [begin, end] : {std::pair(0, cut), std::pair(cut, size.x)}) {
        const std::size_t at = volume.offset(begin, j, k), count = static_cast<std::size_t>(end - begin);
        strength.at_row({begin, j, k}, gradients.subspan(at, count), std::span(felt).subspan(at, count));
      }
    }
  }
  return felt;
}

TEST(FeltStrength, OfModesThatNameTwoTissuesIsThatOfEachVoxelSampledToTheLastBit) {
  std::size_t felt_somewhere = 0, scenes_felt = 0;
  unsigned seed = 1;
  for (const auto& volume : balls()) {
    const std::vector<glm::vec3> gradients = io::GradientKernel(volume, scale_mm).whole();
    RandomScene random_scene(seed++);
    for (int round = 0; round < 8; ++round) {
      const Scene scene = random_scene();
      const Plan plan = make_plan(scene, io::fields_of(*volume), {});
      const std::vector<const ActiveMode*> modes = holding_modes(plan);
      const std::vector<float> wanted = felt_one_by_one(volume, scene, modes);
      const std::vector<float> felt = felt_by_rows(*volume, scene, modes, gradients);
      for (std::size_t n = 0; n < felt.size(); ++n) ASSERT_EQ(felt[n], wanted[n]) << n << ", round " << round;
      const auto felt_here = static_cast<std::size_t>(std::ranges::count_if(wanted, [](float f) { return f > 0; }));
      felt_somewhere += felt_here;
      scenes_felt += felt_here > 0 ? 1U : 0U;
    }
  }
  EXPECT_GT(felt_somewhere, 10'000U);
  EXPECT_GT(scenes_felt, 16U);
}

}  // namespace
}  // namespace palpate::modes
