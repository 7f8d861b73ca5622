#pragma once

/// The scan's own edge beside places of a structure's outline, for strokes along it.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "io/progress.h"
#include "io/structures/distance_field.h"
#include "io/volume.h"

namespace palpate::plugin {

struct EdgeBeside {
  io::Vec3 place_mm{0};    ///< of the edge
  double off_mm = 0;       ///< from the given place, along the outline's normal; positive: inwards
  double known_to_mm = 0;  ///< two standard deviations
};

/// The edge within this distance of each place along the outline's normal; none if the scan has no edge. Takes about a
/// millisecond for each place. Throws io::Cancelled.
std::vector<std::optional<EdgeBeside>> edges_beside(std::span<const io::Vec3> places, const io::DistanceField& outline,
                                                    const std::shared_ptr<const io::Volume>& scan, double within_mm,
                                                    const io::Progress& progress = {});

/// The uncertainty of each place of a felt stroke: that of the scan's edge if the place is on it, else 0 (exact).
std::vector<double> known_to_of(std::span<const std::optional<EdgeBeside>> edges);

/// The first crossing of an outline on a straight path; none if there is none. The outline is sampled every half
/// millimeter, also outside its box: not for the tick.
std::optional<io::Vec3> first_on_outline(const io::DistanceField& outline, const io::Vec3& from, const io::Vec3& to);

}  // namespace palpate::plugin
