#pragma once

/// The site of a boundary at each place in a CT: skin, lung, table.

#include <glm/vec3.hpp>
#include <memory>

#include "io/volume.h"
#include "modes/scene/site.h"

namespace palpate::modes {

namespace internal {
class Regions;
}

class SiteMap {
 public:
  /// Takes about a tenth of a second, and a byte for each 2.5 mm cube. `threads` 0: all cores.
  explicit SiteMap(const std::shared_ptr<const io::Volume>& volume, int threads = 0);
  ~SiteMap();
  SiteMap(const SiteMap&) = delete;
  SiteMap& operator=(const SiteMap&) = delete;

  /// Whether it was made from this scan. It does not keep the scan.
  bool is_of(const std::shared_ptr<const io::Volume>& volume) const noexcept { return volume_.lock() == volume; }
  /// The site of a boundary at a place, mm. `denser` points to its denser side (patient space, any length). Always
  /// `elsewhere` in a scan that is not a CT.
  Site at(const glm::dvec3& place_mm, const glm::dvec3& denser) const;

 private:
  std::weak_ptr<const io::Volume> volume_;
  io::Geometry geometry_;
  std::unique_ptr<const internal::Regions> regions_;  // null in a scan that is not a CT
  double reach_mm_ = 0;
};

}  // namespace palpate::modes
