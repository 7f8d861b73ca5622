#pragma once

/// Pictures of the places of marks, to be stored beside the scan.

#include <memory>
#include <vector>

#include "io/results/measurement_report.h"
#include "io/volume.h"
#include "plugin/recording/marks.h"

namespace palpate::plugin {

/// One for each mark: the axial slice through it, 100 mm wide, with a cross at the mark. They do not name the patient.
std::vector<io::Picture> pictures_of(const Marks& marks, const std::shared_ptr<const io::Volume>& volume);

}  // namespace palpate::plugin
