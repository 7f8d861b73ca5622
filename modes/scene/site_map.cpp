#include "modes/scene/site_map.h"

#include <glm/common.hpp>

#include "io/fields/gradient.h"
#include "modes/scene/edge_sites.h"
#include "modes/scene/regions.h"

namespace palpate::modes {

SiteMap::SiteMap(const std::shared_ptr<const io::Volume>& volume, int threads)
    : volume_(volume),
      geometry_(volume->geometry),
      regions_(volume->unit == "HU" ? std::make_unique<const internal::Regions>(*volume, threads) : nullptr),
      reach_mm_(internal::reach_of_sides * io::default_gradient_scale_mm(volume->geometry)) {}

SiteMap::~SiteMap() = default;

Site SiteMap::at(const glm::dvec3& place_mm, const glm::dvec3& denser) const {
  if (!regions_) return Site::elsewhere;
  const glm::ivec3 voxel(glm::round(geometry_.to_index(place_mm)));
  return internal::site_of(regions_->sides(geometry_, voxel, denser, reach_mm_));
}

}  // namespace palpate::modes
