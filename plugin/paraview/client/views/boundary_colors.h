#pragma once

/// The boundaries' colors in the volume's rendering: each as a thin coat where it is felt.

#include <vector>

#include "modes/scene/scene.h"
#include "plugin/paraview/client/views/sight_line.h"

class vtkSMProxy;

namespace palpate::plugin {

/// The value at which a boundary begins to be felt: where its gate over the value is half open. NaN if it has no such
/// gate.
double felt_value(const modes::Mode& mode);

/// Colors and opacity of the volume's representation for those boundaries of the scene that are switched on; leaves
/// them as they are where there is none.
void color_volume(vtkSMProxy& representation, const modes::Scene& scene, double low, double high);

/// The opacity of a volume's representation as it is shown now, for each mm of the patient.
std::vector<OpacityNode> opacity_of(vtkSMProxy& representation);

}  // namespace palpate::plugin
