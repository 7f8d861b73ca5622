#pragma once

#include <vtkSMPTools.h>

#include <string>

namespace palpate::plugin {

/// Runs `work`, in which VTK's parallel loops use all cores. Debian's ParaView runs them one after the other unless it
/// is told otherwise. `work` must not throw.
template <typename Work>
void on_all_cores(Work&& work) {
  vtkSMPTools::LocalScope(vtkSMPTools::Config{std::string("STDThread")}, work);
}

}  // namespace palpate::plugin
