#pragma once

/// A stroke in readable form: charts, a table, and one point in words.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "modes/scene/plan.h"
#include "plugin/report/chart.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/session/stroke.h"

namespace palpate::plugin {

/// A boundary met by a stroke, and the uncertainty of its position.
struct MetBoundary {
  Contact contact;
  double depth_mm = 0;                ///< of the proxy along the stroke, when it was first held
  std::optional<double> known_to_mm;  ///< across the boundary: known_to_mm() in held_boundary.h
  /// The uncertainty along the stroke, which may cross the boundary at a slant: at 95 of 100 places the true boundary
  /// is within depth_mm +- this. None if unknown, or if the stroke runs nearly along the boundary.
  std::optional<double> known_along_mm;
};

/// A stroke with its ticks; the unit is the scan's.
struct Profile {
  std::vector<StrokePoint> stroke;
  std::shared_ptr<const modes::Plan> plan;
  modes::Scene scene;
  std::string unit;
  double limit_n = 0;                 ///< the largest force on the stylus: drawn across the forces
  std::vector<MetBoundary> met = {};  ///< in the order of the stroke: met_along()
};

/// The scene's boundaries met by the profile's stroke, with their strengths.
std::vector<MetBoundary> met_along(const Profile& profile, const PreparedScene& felt);

/// Every n-th point, so that about `most` remain: as many as a chart on a screen can show.
Profile thinned(const Profile& profile, std::size_t most);

/// The probe's distance along the stroke, mm.
double depth_of(const Profile& profile, std::size_t point);

/// Charts over the distance along the stroke: force, in the color of the boundary that pushes; value at the probe and
/// at the proxy, over the tissues crossed; distance from the proxy to the probe. Boundaries are marked where they are
/// met, with a band as wide as the uncertainty of their place.
std::vector<Chart> charts_of(const Profile& profile);

/// One line a tick: depth, positions, force, values, tissue, the pushing boundary, its force, and the uncertainty of
/// its position. Throws std::runtime_error naming the file.
void write_csv(const Profile& profile, const std::filesystem::path& file);

/// "12.3 mm: 0.84 N by skin (plane), -310 HU, soft tissue"
std::string point_in_words(const Profile& profile, std::size_t point);

}  // namespace palpate::plugin
