#pragma once

/// The displacement of an outline's points to the scan's own edge, such that the new outline is as smooth as the old
/// one and has the same parts.
///
/// The new surface is phi(x) = way(x), with the distance phi from the old surface and the displacement way. It keeps
/// the parts of the old surface if on the way phi is always steeper than the displacement: the distance from a surface
/// has slope 1, but between two walls it has none. (F. Chazal, A. Lieutier, "The lambda-medial axis", Graphical Models
/// 67, 2005.) So the displacement's slope along the surface is limited, and each way ends before the slope of phi is
/// low. Ways that are too long are shortened, to zero if necessary.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "io/structures/distance_field.h"
#include "io/structures/edit.h"
#include "io/structures/outline_places.h"
#include "io/structures/scan_edge.h"

namespace palpate::io::internal {

struct EdgeWay {
  OutlinePlace at;
  double mm = 0;          ///< displacement along the inward normal
  bool stays = true;      ///< the outline stays there exactly
  bool has_edge = false;  ///< in the scan
  double edge_mm = 0;     ///< the position of that edge along the inward normal
  double known_to_mm = 0;

  /// Whether the outline stops short of the scan's edge: because neighboring places disagree, the radius is near, or a
  /// part would appear or vanish.
  bool is_held_back() const { return has_edge && std::abs(edge_mm - mm) > std::max(known_to_mm, 0.5); }
};

class EdgeWays {
 public:
  /// Searches the scan's edge at all places within the edit's radius. Throws InvalidInput if the outline is not within
  /// it.
  EdgeWays(const DistanceField& before, const ScanEdgeEdit& edit, const ScanValues& scan, int threads);

  /// Halves the ways of the places near these points; after some rounds, or if `end` is set, makes them zero. False if
  /// none of the places had a way.
  bool hold_back(const std::vector<Vec3>& points, const DistanceField& before, bool end);

  /// The displacement at a point, from its distance and the gradient there: smooth, and 0 at the radius and beyond.
  double way_at(const Vec3& at, const Distance& before) const;

  const std::vector<EdgeWay>& places() const { return places_; }
  double largest_mm() const { return largest_mm_; }

 private:
  void take_consent();
  void end_before_ridges(const DistanceField& before, int threads);
  void grade();
  void sort_into_cells();
  double limit_at(const Vec3& at) const;

  ScanEdgeEdit edit_;
  double spacing_mm_ = 1;           ///< between places
  double node_mm_ = 1;              ///< of the field
  std::vector<EdgeWay> places_;     ///< some beyond the radius, too: those stay
  std::vector<double> allowed_mm_;  ///< of each place, before its slope is limited
  std::vector<std::uint8_t> halved_;
  double largest_mm_ = 0;
  std::vector<std::vector<std::uint32_t>> cells_;  ///< places near each cell of a lattice around the center
  int cells_wide_ = 0;
};

}  // namespace palpate::io::internal
