#include "colour_maps.h"

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

void set_volume_colours(vtkSMProxy& representation, bool hounsfield, double low, double high) {
  vtkSMProxy* const colours = vtkSMPropertyHelper(&representation, "LookupTable").GetAsProxy();
  vtkSMProxy* const opacity = vtkSMPropertyHelper(&representation, "ScalarOpacityFunction").GetAsProxy();
  if (!colours || !opacity) return;
  vtkSMPropertyHelper(colours, "ColorSpace").Set(0);
  vtkSMPropertyHelper(colours, "AutomaticRescaleRangeMode").Set(-1);
  const auto point = [&](double part) { return low + part * (high - low); };
  if (hounsfield) {
    set_numbers(*colours, "RGBPoints", {-1000, 0.3, 0.15, 0.1, -300, 0.75, 0.5,  0.4, 100,  0.8,
                                        0.4,   0.3, 300,  0.9, 0.8,  0.65, 1200, 1,   0.97, 0.9});
    set_numbers(*opacity, "Points", {-1000, 0, 0.5, 0,   -400, 0, 0.5, 0,   -250, 0.03, 0.5,  0,   100, 0,
                                     0.5,   0, 180, 0.0, 0.5,  0, 500, 0.5, 0.5,  0,    1500, 0.9, 0.5, 0});
  } else {
    set_numbers(*colours, "RGBPoints", {low, 0, 0, 0, point(0.3), 0.6, 0.35, 0.3, high, 1, 0.97, 0.9});
    set_numbers(*opacity, "Points",
                {low, 0, 0.5, 0, point(0.15), 0, 0.5, 0, point(0.4), 0.08, 0.5, 0, high, 0.6, 0.5, 0});
  }
  colours->UpdateVTKObjects();
  opacity->UpdateVTKObjects();
}

}  // namespace palpate::plugin
