#pragma once

/// Background analysis of a loaded scan: the scene that it suggests, and the histograms behind its transfer functions.

#include <memory>
#include <optional>
#include <vector>

#include "io/fields/histogram.h"
#include "io/progress.h"
#include "io/volume.h"
#include "modes/scene/scene.h"
#include "modes/scene/site_map.h"

namespace palpate::plugin {

/// A histogram with bins of equal width.
struct Counts {
  io::Bins bins;
  std::vector<double> counts;
};

struct ScanStudy {
  std::optional<modes::Scene> suggested;  ///< none if nothing was found, and for a flow
  Counts values;                          ///< in the scan's unit
  Counts magnitudes;                      ///< of the gradient, per mm
  std::shared_ptr<const modes::SiteMap> sites;
};

/// Throws io::Cancelled.
ScanStudy study_scan(const std::shared_ptr<const io::Volume>& volume, const io::Progress& progress);

}  // namespace palpate::plugin
