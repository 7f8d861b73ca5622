#pragma once

/// Places at which a structure's outline is doubtful: the scan's own edge lies elsewhere, or there is none if the
/// outline ends; and small parts and holes.
///
/// Every 2 mm on the outline the scan's edge is searched for along the normal, within 6 mm (scan_edge.h).
/// An edge counts if the tissue on its inner side is more similar to the structure's than that on its outer side. A
/// place is doubtful if the edge lies farther away than twice its own +- and than half a voxel. It is doubtful without
/// an edge, too, if a third of the outline has one and the tissue is alike on both sides. Doubtful places of one kind
/// and side that lie beside each other are one.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/progress.h"
#include "io/structures/distance_field.h"
#include "io/structures/scan_edge.h"

namespace palpate::io {

enum class DoubtKind : std::uint8_t {
  edge,     ///< the scan's edge lies beside the outline
  no_edge,  ///< the scan has no edge where the outline ends in the midst of a tissue: a cap cut off, a leak
  island,   ///< a part smaller than a tenth of the largest
  hole      ///< a hole smaller than a tenth of the largest part
};

/// "edge", "no_edge", "island", "hole".
const char* name_of(DoubtKind kind) noexcept;

struct DoubtfulPlace {
  DoubtKind kind = DoubtKind::edge;
  Vec3 position_mm{0};  ///< on the outline
  Vec3 normal{0};       ///< of the outline there: unit, outwards
  double area_mm2 = 0;  ///< of the outline
  double mean_mm = 0;   ///< from the outline to the edge, by area; positive: the edge lies outside. Islands and holes:
                        ///< volume by area. No edge: 0
  double largest_mm = 0;   ///< the largest distance, with its sign. Islands and holes: how deep. No edge: 0
  double known_to_mm = 0;  ///< +- of the edges in the mean; 0 if there is none
};

struct DoubtfulPlaces {
  std::vector<DoubtfulPlace> places;  ///< by area times distance, the most doubtful first
  std::size_t sampled = 0;            ///< examined places of the outline
  std::size_t without_edge = 0;       ///< those of them at which the scan has no edge
};

/// Distance from the outline within which an edge is searched for.
inline constexpr double doubt_within_mm = 6;

/// Takes about a millisecond for each 10 mm^2 of the outline. Throws Cancelled.
DoubtfulPlaces doubtful_places(const ScanValues& scan, const DistanceField& structure, const Progress& progress = {},
                               int threads = 0);

}  // namespace palpate::io
