#include "modes/scene/felt_strength.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/fields/gradient.h"
#include "modes/scene/scene_json.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

/// Air, soft tissue and bone in a ball, with noise; values that would be felt count as padding.
std::shared_ptr<const io::Volume> ball() {
  testdata::Phantom phantom = testdata::make_sphere(18);
  phantom.bodies.push_back(testdata::make_sphere(9, testdata::bone_hu).bodies.front());
  io::Volume volume = testdata::scan(phantom, testdata::make_geometry({.size = {150, 50, 20}}), {.noise = 40});
  volume.padding = {(-100 - volume.intercept) / volume.slope, (20 - volume.intercept) / volume.slope};
  return std::make_shared<const io::Volume>(std::move(volume));
}

/// Each voxel for itself, as the tick adds up a sample's strengths.
float felt_at(const io::Volume& volume, const std::vector<const ActiveMode*>& modes, const glm::ivec3& at,
              const glm::vec3& gradient) {
  if (volume.is_padding(at.x, at.y, at.z)) return 0;
  io::Sample sample;
  sample.inside = true;
  sample.value = volume.value_at(at.x, at.y, at.z);
  sample.gradient = gradient;
  double sum = 0;
  for (const ActiveMode* mode : modes) sum += mode->strength(sample);
  return static_cast<float>(sum);
}

Scene smooth_scene() {
  Scene scene = load_scene("ct-chest");
  for (Mode& mode : scene.modes) {
    const auto nodes = mode.strength_n.nodes();
    mode.strength_n = TransferFunction({nodes.begin(), nodes.end()}, Interpolation::monotone_cubic);
    mode.gates.push_back({Datum::gradient_magnitude, TransferFunction({{30, 0.5}, {90, 1.5}, {140, 0.1}})});
    mode.gates.push_back({Datum::value, TransferFunction(0.75)});
  }
  return scene;
}

TEST(FeltStrength, IsTheSumOfTheSamplesStrengthsToTheLastBit) {
  const auto volume = ball();
  const glm::ivec3 size = volume->geometry.dimensions;
  std::vector<glm::vec3> gradients = io::GradientKernel(volume, 2).whole();
  gradients[volume->offset(75, 25, 10)].x = std::numeric_limits<float>::quiet_NaN();
  for (const Scene& scene : {load_scene("ct-skin-and-bone"), smooth_scene()}) {
    const Plan plan = make_plan(scene, io::FieldSet::value | io::FieldSet::gradient, {});
    std::vector<const ActiveMode*> modes;
    for (const ActiveMode& mode : plan.modes) modes.push_back(&mode);
    const FeltStrength strength(*volume, modes, io::ValueMethod::cubic, 2);
    std::size_t felt_somewhere = 0;
    for (int k = 0; k < size.z; ++k) {
      for (int j = 0; j < size.y; ++j) {
        // Rows of all lengths: what is read at once is shorter than a row.
        const int first = (3 * j + k) % 67;
        std::vector<float> felt(static_cast<std::size_t>(size.x - first), -1.0F);
        strength.at_row({first, j, k}, std::span(gradients).subspan(volume->offset(first, j, k), felt.size()), felt);
        for (int i = first; i < size.x; ++i) {
          const float wanted = felt_at(*volume, modes, {i, j, k}, gradients[volume->offset(i, j, k)]);
          ASSERT_EQ(felt[static_cast<std::size_t>(i - first)], wanted) << i << ", " << j << ", " << k;
          felt_somewhere += wanted > 0 ? 1 : 0;
        }
      }
    }
    EXPECT_GT(felt_somewhere, 500U);
  }
}

TEST(FeltStrength, IsOfTheModesThatHoldAtTheScansOwnBoundaries) {
  Scene scene = load_scene("ct-skin-and-bone");
  const auto names = [&scene] {
    const Plan plan = make_plan(scene, io::FieldSet::value | io::FieldSet::gradient | io::FieldSet::distance, {});
    std::vector<std::string> names;
    for (const ActiveMode* mode : holding_modes(plan)) names.push_back(scene.modes[mode->scene_index].name);
    return names;
  };
  EXPECT_EQ(names(), (std::vector<std::string>{"skin", "bone"}));
  // What holds at the edge of a structure is felt there, and not wherever the scan has a boundary.
  scene.structures = {{.name = "liver", .file = "seg.dcm", .segment = "Liver"}};
  for (const char* type : {"surface", "keep_out", "keep_in"}) {
    scene.modes.push_back({.type = type, .name = type, .strength_n = TransferFunction(1.0), .structure = "liver"});
  }
  EXPECT_EQ(names(), (std::vector<std::string>{"skin", "bone"}));
}

}  // namespace
}  // namespace palpate::modes
