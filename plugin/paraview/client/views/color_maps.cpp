#include "plugin/paraview/client/views/color_maps.h"

#include <pqServer.h>
#include <vtkNew.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMTransferFunctionManager.h>

#include <algorithm>
#include <vector>

namespace palpate::plugin {
namespace {

void set_numbers(vtkSMProxy& proxy, const char* property, const std::vector<double>& values) {
  vtkSMPropertyHelper(&proxy, property).Set(values.data(), static_cast<unsigned>(values.size()));
}

}  // namespace

vtkSMProxy* gray_map(pqServer& server) {
  vtkNew<vtkSMTransferFunctionManager> manager;
  // With an opacity function of its own: ParaView's color map editor crashes on a map without one.
  vtkSMProxy* const map = manager->GetColorTransferFunction("PalpateGray", server.proxyManager());
  vtkSMPropertyHelper(map, "ColorSpace").Set(0);                  // RGB: gray stays gray
  vtkSMPropertyHelper(map, "AutomaticRescaleRangeMode").Set(-1);  // never: the window is the radiologist's
  vtkSMPropertyHelper(map, "ScalarRangeInitialized").Set(1);
  map->UpdateVTKObjects();
  return map;
}

void set_window(vtkSMProxy& gray_map, const Window& window) {
  const double low = window.level - window.width / 2;
  set_numbers(gray_map, "RGBPoints", {low, 0, 0, 0, low + window.width, 1, 1, 1});
  gray_map.UpdateVTKObjects();
}

Window window_of(vtkSMProxy& gray_map) {
  const std::vector<double> points = vtkSMPropertyHelper(&gray_map, "RGBPoints").GetDoubleArray();
  if (points.size() < 8) return {};
  const double low = points.front(), high = points[points.size() - 4];
  return {.level = (low + high) / 2, .width = high - low};
}

void set_volume_look(vtkSMProxy& representation, const VolumeLook& look) {
  vtkSMProxy* const colors = vtkSMPropertyHelper(&representation, "LookupTable").GetAsProxy();
  vtkSMProxy* const opacity = vtkSMPropertyHelper(&representation, "ScalarOpacityFunction").GetAsProxy();
  if (!colors || !opacity) return;
  vtkSMPropertyHelper(colors, "ColorSpace").Set(0);
  vtkSMPropertyHelper(colors, "AutomaticRescaleRangeMode").Set(-1);
  set_numbers(*colors, "RGBPoints", look.colors);
  set_numbers(*opacity, "Points", look.opacity);
  colors->UpdateVTKObjects();
  opacity->UpdateVTKObjects();
  vtkSMPropertyHelper(&representation, "Shade", true).Set(look.shaded ? 1 : 0);
  // Where the values do not change, as where the scan ends in the patient, only ambient light is reflected.
  constexpr double ambient = 0.35, diffuse = 0.75, specular = 0.15;
  vtkSMPropertyHelper(&representation, "Ambient", true).Set(ambient);
  vtkSMPropertyHelper(&representation, "Diffuse", true).Set(diffuse);
  vtkSMPropertyHelper(&representation, "Specular", true).Set(specular);
  representation.UpdateVTKObjects();
}

std::optional<std::size_t> look_of(vtkSMProxy& representation, const std::vector<VolumeLook>& looks) {
  vtkSMProxy* const colors = vtkSMPropertyHelper(&representation, "LookupTable").GetAsProxy();
  vtkSMProxy* const opacity = vtkSMPropertyHelper(&representation, "ScalarOpacityFunction").GetAsProxy();
  if (!colors || !opacity) return std::nullopt;
  const std::vector<double> points = vtkSMPropertyHelper(colors, "RGBPoints").GetDoubleArray();
  const std::vector<double> opaque = vtkSMPropertyHelper(opacity, "Points").GetDoubleArray();
  const bool shaded = vtkSMPropertyHelper(&representation, "Shade", true).GetAsInt() != 0;
  const auto same = std::ranges::find_if(looks, [&](const VolumeLook& look) {
    return look.colors == points && look.opacity == opaque && look.shaded == shaded;
  });
  if (same == looks.end()) return std::nullopt;
  return static_cast<std::size_t>(same - looks.begin());
}

}  // namespace palpate::plugin
