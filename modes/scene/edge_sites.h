#pragma once

/// Where the edges of a CT lie: at the skin, at the lung, at other air inside the body, at the table.

#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "io/fields/histogram.h"
#include "modes/scene/regions.h"
#include "modes/scene/site.h"

namespace palpate::modes::internal {

Site site_of(const Sides& sides) noexcept;

/// In units of the gradient's scale: both sides of an edge lie within this distance.
inline constexpr double reach_of_sides = 4;

/// Remembers the place of every edge that a histogram counts.
class EdgeSites {
 public:
  /// The volume and the regions have to outlive it. `reach_mm`: how far from an edge its two sides are searched.
  EdgeSites(const io::Volume& volume, const Regions& regions, double reach_mm);

  /// Adds the edges of one block; may be called by several threads at a time.
  void add(std::span<const io::CountedEdge> edges);
  /// Counts the edges whose low side lies in bins [low_first, low_end) and whose high side lies in [high_first,
  /// high_end).
  SiteCounts count(int low_first, int low_end, int high_first, int high_end) const;

 private:
  struct SitedEdge {
    std::uint16_t low, high;
    Site site;
  };
  const io::Volume& volume_;
  const Regions& regions_;
  double reach_mm_;
  std::mutex adding_;
  std::vector<SitedEdge> edges_;
};

}  // namespace palpate::modes::internal
