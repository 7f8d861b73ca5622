#pragma once

/// Grey windows for slices, and colours and opacity for the volume.

#include <array>
#include <string>

class pqServer;
class vtkSMProxy;

namespace palpate::plugin {

/// Values below level - width / 2 are black, above level + width / 2 white.
struct Window {
  double level = 40;
  double width = 400;
};

struct NamedWindow {
  const char* name;
  Window window;
};
/// Of CT, HU.
inline constexpr std::array<NamedWindow, 4> ct_windows{
    {{"Soft tissue", {40, 400}}, {"Brain", {40, 80}}, {"Lung", {-600, 1500}}, {"Bone", {480, 2500}}}};

/// The grey map of all slices, apart from the colours of the volume; made on first use, kept by state files.
vtkSMProxy* grey_map(pqServer& server);
void set_window(vtkSMProxy& grey_map, const Window& window);

/// Colours and opacity of the volume for the unit and range of its values, set on the maps of a representation's array.
/// CT: skin faint, bone clear. Others: the brighter half from faint to clear.
void set_volume_colours(vtkSMProxy& representation, bool hounsfield, double low, double high);

}  // namespace palpate::plugin
