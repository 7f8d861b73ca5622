#pragma once

/// What is found out about a scan once it is loaded, in the background: the scene that it suggests, and what its
/// transfer functions are drawn over.

#include <memory>
#include <vector>

#include "io/fields/histogram.h"
#include "io/progress.h"
#include "io/volume.h"
#include "modes/scene/scene.h"
#include "modes/scene/site_map.h"

namespace palpate::plugin {

/// How often something lies in each of evenly wide bins.
struct Counts {
  io::Bins bins;
  std::vector<double> counts;
};

struct ScanStudy {
  modes::Scene suggested;  ///< a starting scene where nothing was found
  Counts values;           ///< in the scan's unit
  Counts magnitudes;       ///< of the gradient, per mm
  std::shared_ptr<const modes::SiteMap> sites;
};

/// Throws io::Cancelled.
ScanStudy study_scan(const std::shared_ptr<const io::Volume>& volume, const io::Progress& progress);

}  // namespace palpate::plugin
