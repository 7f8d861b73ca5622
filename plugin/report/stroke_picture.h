#pragma once

/// A stroke for people: as charts, as a table, and a point of it in words.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "modes/scene/plan.h"
#include "plugin/report/chart.h"
#include "plugin/session/stroke.h"

namespace palpate::plugin {

/// A stroke and what it went through; the unit is the scan's.
struct Profile {
  std::vector<StrokePoint> stroke;
  std::shared_ptr<const modes::Plan> plan;
  modes::Scene scene;
  std::string unit;
  double limit_n = 0;  ///< that the stylus is never fed more than: drawn across the forces
};

/// Every so many points, that at most about `most` are left: what a chart on a screen can show.
Profile thinned(const Profile& profile, std::size_t most);

/// How far the probe has come along the stroke, mm.
double depth_of(const Profile& profile, std::size_t point);

/// Force, in the color of the boundary that pushes; value on the way and at the proxy, over the tissues crossed; how
/// far the probe is ahead of the proxy. All over the distance along the stroke, boundaries marked where they are met.
std::vector<Chart> charts_of(const Profile& profile);

/// One line a frame: depth, places, force, values, tissue, and who pushes with what. Throws std::runtime_error naming
/// the file.
void write_csv(const Profile& profile, const std::filesystem::path& file);

/// "12.3 mm: 0.84 N by skin (plane), -310 HU, soft tissue"
std::string point_in_words(const Profile& profile, std::size_t point);

}  // namespace palpate::plugin
