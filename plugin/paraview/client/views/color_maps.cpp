#include "plugin/paraview/client/views/color_maps.h"

#include <pqServer.h>
#include <vtkNew.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMTransferFunctionManager.h>

#include <vector>

namespace palpate::plugin {
namespace {

void set_numbers(vtkSMProxy& proxy, const char* property, const std::vector<double>& values) {
  vtkSMPropertyHelper(&proxy, property).Set(values.data(), static_cast<unsigned>(values.size()));
}

}  // namespace

vtkSMProxy* grey_map(pqServer& server) {
  vtkNew<vtkSMTransferFunctionManager> manager;
  // With an opacity function of its own: ParaView's colour map editor crashes on a map without one.
  vtkSMProxy* const map = manager->GetColorTransferFunction("PalpateGrey", server.proxyManager());
  vtkSMPropertyHelper(map, "ColorSpace").Set(0);                  // RGB: grey stays grey
  vtkSMPropertyHelper(map, "AutomaticRescaleRangeMode").Set(-1);  // never: the window is the radiologist's
  vtkSMPropertyHelper(map, "ScalarRangeInitialized").Set(1);
  map->UpdateVTKObjects();
  return map;
}

void set_window(vtkSMProxy& grey_map, const Window& window) {
  const double low = window.level - window.width / 2;
  set_numbers(grey_map, "RGBPoints", {low, 0, 0, 0, low + window.width, 1, 1, 1});
  grey_map.UpdateVTKObjects();
}

Window window_of(vtkSMProxy& grey_map) {
  const std::vector<double> points = vtkSMPropertyHelper(&grey_map, "RGBPoints").GetDoubleArray();
  if (points.size() < 8) return {};
  const double low = points.front(), high = points[points.size() - 4];
  return {.level = (low + high) / 2, .width = high - low};
}

void set_volume_look(vtkSMProxy& representation, const VolumeLook& look) {
  vtkSMProxy* const colours = vtkSMPropertyHelper(&representation, "LookupTable").GetAsProxy();
  vtkSMProxy* const opacity = vtkSMPropertyHelper(&representation, "ScalarOpacityFunction").GetAsProxy();
  if (!colours || !opacity) return;
  vtkSMPropertyHelper(colours, "ColorSpace").Set(0);
  vtkSMPropertyHelper(colours, "AutomaticRescaleRangeMode").Set(-1);
  set_numbers(*colours, "RGBPoints", look.colours);
  set_numbers(*opacity, "Points", look.opacity);
  colours->UpdateVTKObjects();
  opacity->UpdateVTKObjects();
}

}  // namespace palpate::plugin
