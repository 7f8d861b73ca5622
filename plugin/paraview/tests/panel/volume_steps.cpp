#include "plugin/paraview/tests/panel/volume_steps.h"

#include <pqCoreUtilities.h>
#include <pqRenderView.h>
#include <vtkPVRenderView.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkVolume.h>
#include <vtkVolumeCollection.h>

#include <QWidget>

#include <string>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

vtkRenderer& volume_renderer() {
  auto* const client = render_view("Volume").getRenderViewProxy()->GetClientSideView();
  return *vtkPVRenderView::SafeDownCast(client)->GetRenderer();
}

QAction& action(const char* name) {
  auto* const found = pqCoreUtilities::mainWidget()->findChild<QAction*>(QLatin1String(name));
  expect(found != nullptr, std::string("there is an action ") + name);
  return *found;
}

bool scan_is_drawn(vtkRenderer& in) {
  vtkVolumeCollection& volumes = *in.GetVolumes();
  for (int n = 0; n < volumes.GetNumberOfItems(); ++n) {
    if (vtkVolume::SafeDownCast(volumes.GetItemAsObject(n))->GetVisibility()) return true;
  }
  return false;
}
