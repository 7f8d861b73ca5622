#pragma once

#include <vtkSMPTools.h>

#include <string>

namespace palpate::plugin {

/// Runs `work` so that VTK's parallel loops in it use all cores. By default Debian's ParaView runs these loops one
/// after the other. `work` must not throw.
template <typename Work>
void on_all_cores(Work&& work) {
  vtkSMPTools::LocalScope(vtkSMPTools::Config{std::string("STDThread")}, work);
}

}  // namespace palpate::plugin
