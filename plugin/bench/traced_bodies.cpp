#include "plugin/bench/traced_bodies.h"

#include <random>
#include <vector>

#include "io/fields/filtered.h"
#include "io/structures/label_image.h"
#include "io/structures/structure.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

constexpr double noise_hu = 12, blur_mm = 0.6;

}  // namespace

std::shared_ptr<const io::DistanceField> outline_of(const io::Geometry& lattice, const OutlineMm& mm, double reach_mm) {
  io::Mask mask;
  mask.geometry = lattice;
  mask.size = lattice.dimensions;
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        mask.occupancy.push_back(mm(lattice.to_patient(glm::dvec3(i, j, k))) > 0 ? io::Mask::full : 0);
      }
    }
  }
  return io::distance_of(mask, {.reach_mm = reach_mm});
}

std::shared_ptr<const io::Volume> soft_scan(const testdata::Phantom& phantom, const io::Geometry& geometry) {
  const auto sharp = std::make_shared<const io::Volume>(testdata::scan(phantom, geometry, {.quantised = false}));
  io::Volume volume = *io::filtered(sharp, {.type = io::find_filter_type("gaussian"), .sigma_mm = blur_mm});
  volume.filtered_from = nullptr;
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, noise_hu);
  for (float& value : std::get<std::vector<float>>(volume.voxels)) value += noise(random);
  return std::make_shared<const io::Volume>(std::move(volume));
}

}  // namespace palpate::plugin
