#pragma once

/// ParaView's color maps for slices and volumes of a scan.

#include <cstddef>
#include <optional>
#include <vector>

#include "plugin/paraview/common/scan_look.h"

class pqServer;
class vtkSMProxy;

namespace palpate::plugin {

/// The gray map of all slices, apart from the colors of the volume; made on first use, kept by state files.
vtkSMProxy* gray_map(pqServer& server);
void set_window(vtkSMProxy& gray_map, const Window& window);
Window window_of(vtkSMProxy& gray_map);

/// Applies an appearance to the color maps of a representation's array.
void set_volume_look(vtkSMProxy& representation, const VolumeLook& look);
/// The index of a representation's appearance; none: it is not one of these.
std::optional<std::size_t> look_of(vtkSMProxy& representation, const std::vector<VolumeLook>& looks);

}  // namespace palpate::plugin
