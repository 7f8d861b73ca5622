#include <pqPipelineSource.h>
#include <pqServer.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/panel/correct_box.h"
#include "plugin/paraview/client/panel/outline_out.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/paraview/client/widgets/fold.h"

// Structure sets belong to the scan that is shown.

namespace palpate::plugin {

void PanelParts::connect_structures() {
  QObject::connect(structures, &StructuresSection::listed, &dock,
                   [this] { structures_fold->set_note(structures->in_words()); });
}

void PanelParts::show_structures(const ScanHandle& handle) {
  pqPipelineSource& reader = *readers.source();
  if (!reader.getServer()->isRemote()) {
    structures->set_scan(handle.volume, vtkSMPropertyHelper(reader.getProxy(), "FileName").GetAsString());
    return;
  }
  // The server's own: a folder of this machine that has the same name may hold others.
  structures->set_scan(handle.volume, {});
  served.get(reader, [this, handle](const auto& files, const QString& said) {
    structures->add(files, said);
    if (touching.live().scan()) return;
    // A state's scene, which names a structure that was not here before.
    emit touching.told({}, false);
    show_frame(handle);
  });
}

void PanelParts::leave_structures() {
  served.cancel();
  structures->correct_box().out().leave_scan();
  structures->set_scan(nullptr, {});
}

}  // namespace palpate::plugin
