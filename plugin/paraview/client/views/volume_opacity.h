#pragma once

/// The opacity of the volume's rendering.

#include <vector>

#include "plugin/paraview/client/views/sight_line.h"

class vtkSMProxy;

namespace palpate::plugin {

/// The opacity of a volume's representation as it is shown now, for each mm in the patient.
std::vector<OpacityNode> opacity_of(vtkSMProxy& representation);

}  // namespace palpate::plugin
