#include "io/structures/field_change.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "io/structures/coarse_change.h"
#include "io/structures/field_patch.h"

namespace palpate::io::internal {

double distance_to(const Stretch& stretch, const Vec3& place) noexcept {
  const Vec3 along = stretch.to - stretch.from, way = place - stretch.from;
  const double length = glm::dot(along, along);
  const double part = length > 0 ? std::clamp(glm::dot(way, along) / length, 0.0, 1.0) : 0;
  return glm::length(way - part * along);
}

std::shared_ptr<const DistanceField> changed(const std::shared_ptr<const DistanceField>& before,
                                             const FieldChange& change, int threads, const Settle& settle) {
  const DistanceParts& old = before->parts();
  const double around_mm = old.kept_within_mm();
  Patch patch = patch_around(old, change, around_mm);
  std::vector<char> passed;
  if (!choose_bricks(patch, around_mm, threads, passed)) return before;
  measure_anew(patch, passed, threads);
  if (settle) settle(patch);
  DistanceParts parts = stored(patch, threads);
  CoarseChange coarse{.lattice = patch.bricks.lattice, .where = change.where, .within_mm = change.within_mm};
  coarse.lost = patch.lost;
  for (std::size_t n = 0; n < patch.closest.size(); n += 3) {
    if (patch.closest[n].x != nowhere) coarse.surface.push_back(patch.closest[n]);
  }
  coarse.after = [&](const Vec3& at, double mm) {
    const glm::ivec3 place(glm::floor(patch.bricks.lattice.node_of(at) / static_cast<double>(NodeBricks::edge)));
    if (!patch.holds(place)) return mm;
    const auto& near = patch.near[patch.box_at(place)];
    return near.empty() ? mm : change.after(at, mm, near);
  };
  change_coarse(coarse, threads, parts);
  return std::make_shared<const DistanceField>(std::move(parts));
}

}  // namespace palpate::io::internal
