#pragma once

/// Pictures of where marks are, to be stored beside the scan.

#include <memory>
#include <vector>

#include "io/results/measurement_report.h"
#include "io/volume.h"
#include "plugin/recording/marks.h"

namespace palpate::plugin {

/// One for each mark: the axial slice through it, 100 mm wide, with a cross at the mark. No name of a patient is in it.
std::vector<io::Picture> pictures_of(const Marks& marks, const std::shared_ptr<const io::Volume>& volume);

}  // namespace palpate::plugin
