#include <pqPipelineSource.h>
#include <pqServer.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/panel/correct_box.h"
#include "plugin/paraview/client/panel/outline_out.h"
#include "plugin/paraview/client/panel/structures_section.h"

// Connections of the structures, which belong to the scan that is shown.

namespace palpate::plugin {

void PanelParts::show_structures(const ScanHandle& handle) {
  pqPipelineSource& reader = *readers.source();
  if (!reader.getServer()->isRemote()) {
    column->structures->set_scan(handle.volume, vtkSMPropertyHelper(reader.getProxy(), "FileName").GetAsString());
    return;
  }
  // The server's own: a folder of this machine that has the same name may hold others.
  column->structures->set_scan(handle.volume, {});
  served.get(reader, [this](const auto& files, const QString& said) {
    column->structures->add(files, said);
    if (session.live().scan()) return;
    // A state's scene, which names a structure that was not here before.
    emit session.told({}, false);
    if (const ScanHandle* const shown = scans.shown()) show_frame(*shown);  // perhaps another frame by now
  });
}

void PanelParts::leave_structures() {
  served.cancel();
  column->structures->correct_box().out().leave_scan();
  column->structures->set_scan(nullptr, {});
}

}  // namespace palpate::plugin
