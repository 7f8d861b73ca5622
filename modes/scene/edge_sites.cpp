#include "modes/scene/edge_sites.h"

namespace palpate::modes::internal {

Site site_of(const Sides& sides) noexcept {
  if (sides.high == Region::table) return Site::table;
  if (!is_air(sides.low)) return Site::elsewhere;
  if (sides.high == Region::none) return Site::elsewhere;
  if (sides.high == Region::body) {
    return sides.low == Region::room ? Site::skin : sides.low == Region::lung ? Site::lung : Site::inner_air;
  }
  if (sides.low == Region::room || sides.high == Region::room) return Site::cloth;
  return sides.low == Region::lung || sides.high == Region::lung ? Site::lung : Site::inner_air;
}

EdgeSites::EdgeSites(const io::Volume& volume, const Regions& regions, double reach_mm)
    : volume_(volume), regions_(regions), reach_mm_(reach_mm) {}

void EdgeSites::add(std::span<const io::CountedEdge> edges) {
  std::vector<SitedEdge> placed;
  placed.reserve(edges.size());
  for (const io::CountedEdge& edge : edges) {
    const Sides sides = regions_.sides(volume_.geometry, edge.voxel, glm::dvec3(edge.gradient), reach_mm_);
    placed.push_back({static_cast<std::uint16_t>(edge.low), static_cast<std::uint16_t>(edge.high), site_of(sides)});
  }
  const std::scoped_lock lock(adding_);
  edges_.insert(edges_.end(), placed.begin(), placed.end());
}

SiteCounts EdgeSites::count(int low_first, int low_end, int high_first, int high_end) const {
  SiteCounts counts{};
  for (const SitedEdge& edge : edges_) {
    if (edge.low < low_first || edge.low >= low_end || edge.high < high_first || edge.high >= high_end) continue;
    ++counts[static_cast<std::size_t>(edge.site)];
  }
  return counts;
}

}  // namespace palpate::modes::internal
