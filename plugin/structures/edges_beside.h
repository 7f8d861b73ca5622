#pragma once

/// The scan's own edge beside places at a structure's outline, for strokes that go along it.

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
  double off_mm = 0;       ///< from the place that was asked about, along the outline's normal; positive: inwards
  double known_to_mm = 0;  ///< two standard deviations
};

/// Within so many mm of each place along the outline's normal; none if the scan has no edge. Takes about a
/// millisecond for each place. Throws io::Cancelled.
std::vector<std::optional<EdgeBeside>> edges_beside(std::span<const io::Vec3> places, const io::DistanceField& outline,
                                                    const std::shared_ptr<const io::Volume>& scan, double within_mm,
                                                    const io::Progress& progress = {});

/// The +- of each place of a felt stroke: that of the scan's edge if the place lies on it, else 0, exact.
std::vector<double> known_to_of(std::span<const std::optional<EdgeBeside>> edges);

/// Where an outline is first met on a straight way; none if it is not. Within the outline's box or not: it is looked at
/// every half millimeter, so not for the tick.
std::optional<io::Vec3> first_on_outline(const io::DistanceField& outline, const io::Vec3& from, const io::Vec3& to);

}  // namespace palpate::plugin
