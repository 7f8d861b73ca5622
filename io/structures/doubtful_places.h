#pragma once

/// Doubtful places of a structure's outline: places where the scan's own edge is elsewhere, or missing at the end of
/// the structure; and small parts and holes.
///
/// The outline is sampled every 2 mm, and the scan's own edge is searched along the normal, within 6 mm (scan_edge.h).
/// An edge counts if the tissue on its inner side is more like the structure's than that on its outer side. A place is
/// doubtful if the edge is farther away than both twice its own uncertainty and half a voxel. A place without an edge
/// is doubtful, too, if a third of the outline has one and the tissue is alike on both sides. Adjacent doubtful places
/// of one kind and side are joined.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/progress.h"
#include "io/structures/distance_field.h"
#include "io/structures/scan_edge.h"

namespace palpate::io {

enum class DoubtKind : std::uint8_t {
  edge,     ///< the scan's edge is beside the outline
  no_edge,  ///< the scan has no edge where the outline ends within a tissue: a cap cut off, a leak
  island,   ///< a part smaller than a tenth of the largest
  hole      ///< a hole smaller than a tenth of the largest part
};

/// "edge", "no_edge", "island", "hole".
const char* name_of(DoubtKind kind) noexcept;

struct DoubtfulPlace {
  DoubtKind kind = DoubtKind::edge;
  Vec3 position_mm{0};     ///< on the outline
  Vec3 normal{0};          ///< of the outline there: unit, outwards
  double area_mm2 = 0;     ///< of the outline
  double mean_mm = 0;      ///< from the outline to the edge, by area; positive: the edge is outside. Islands and holes:
                           ///< volume by area. No edge: 0
  double largest_mm = 0;   ///< the largest one, with its sign. Islands and holes: depth. No edge: 0
  double known_to_mm = 0;  ///< mean uncertainty of the edges, two standard deviations; 0 if there is none
};

struct DoubtfulPlaces {
  std::vector<DoubtfulPlace> places;  ///< by area times distance, the most doubtful first
  std::size_t sampled = 0;            ///< sampled places of the outline
  std::size_t without_edge = 0;       ///< sampled places at which the scan has no edge
};

/// How far from the outline an edge is searched.
inline constexpr double doubt_within_mm = 6;

/// Takes about a millisecond for each 10 mm^2 of the outline. Throws Cancelled.
DoubtfulPlaces doubtful_places(const ScanValues& scan, const DistanceField& structure, const Progress& progress = {},
                               int threads = 0);

}  // namespace palpate::io
