#include "plugin/paraview/client/views/volume_opacity.h"

#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <algorithm>
#include <cmath>

namespace palpate::plugin {

std::vector<OpacityNode> opacity_of(vtkSMProxy& representation) {
  vtkSMProxy* const opacity = vtkSMPropertyHelper(&representation, "ScalarOpacityFunction").GetAsProxy();
  if (!opacity) return {};
  // Four numbers a node: value, opacity over the unit distance, and two of how the curve bends.
  const std::vector<double> points = vtkSMPropertyHelper(opacity, "Points").GetDoubleArray();
  const double unit_mm = vtkSMPropertyHelper(&representation, "ScalarOpacityUnitDistance", true).GetAsDouble();
  std::vector<OpacityNode> nodes;
  for (std::size_t n = 0; n + 3 < points.size(); n += 4) {
    const double passes = std::clamp(1 - points[n + 1], 0.0, 1.0);
    nodes.push_back({points[n], 1 - std::pow(passes, unit_mm > 0 ? 1 / unit_mm : 1)});
  }
  return nodes;
}

}  // namespace palpate::plugin
