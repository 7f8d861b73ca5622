#include "plugin/paraview/client/views/new_views.h"

#include <pqApplicationCore.h>
#include <pqObjectBuilder.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <pqServer.h>
#include <vtkNew.h>
#include <vtkPVRenderView.h>
#include <vtkSMPVRepresentationProxy.h>
#include <vtkSMParaViewPipelineControllerWithRendering.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMTrace.h>
#include <vtkSMViewLayoutProxy.h>
#include <vtkSmartPointer.h>

#include "plugin/paraview/client/views/scalar_coloring.h"

namespace palpate::plugin {

pqRenderView* make_view(pqServer& server, bool flat) {
  auto* const view = qobject_cast<pqRenderView*>(
      pqApplicationCore::instance()->getObjectBuilder()->createView(pqRenderView::renderViewType(), &server));
  vtkSMProxy& proxy = *view->getProxy();
  const auto set = [&](const char* name, int value) { vtkSMPropertyHelper(&proxy, name, true).Set(value); };
  set("UseColorPaletteForBackground", 0);
  set("OrientationAxesVisibility", 0);  // X, Y, Z
  set("CenterAxesVisibility", 0);
  if (flat) set("InteractionMode", 1);
  const double black[3] = {0, 0, 0};
  vtkSMPropertyHelper(&proxy, "Background").Set(black, 3);
  proxy.UpdateVTKObjects();
  // It blurs the values, and takes as long as all the rest of a picture without a graphics card. Not by the property,
  // whose change ParaView would write into the undo stack later.
  if (flat) vtkPVRenderView::SafeDownCast(view->getRenderViewProxy()->GetClientSideView())->SetUseFXAA(false);
  return view;
}

vtkSMViewLayoutProxy& make_layout(pqServer& server) {
  const auto proxy = vtkSmartPointer<vtkSMProxy>::Take(server.proxyManager()->NewProxy("misc", "ViewLayout"));
  vtkNew<vtkSMParaViewPipelineController> controller;
  controller->InitializeProxy(proxy);
  server.proxyManager()->RegisterProxy("layouts", "Scan", proxy);
  return *vtkSMViewLayoutProxy::SafeDownCast(proxy);
}

void remove_layout(vtkSMViewLayoutProxy& layout) {
  vtkNew<vtkSMParaViewPipelineController> controller;
  controller->UnRegisterProxy(&layout);
}

vtkSMProxy& show_as(const char* representation, vtkSMSourceProxy& image, pqRenderView& view, const char* array) {
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  vtkSMProxy* const shown = controller->Show(&image, 0, view.getViewProxy());
  auto* const proxy = vtkSMPVRepresentationProxy::SafeDownCast(shown);
  proxy->SetRepresentationType(representation);
  color_by_points(*proxy, array);
  hide_scalar_bar(*proxy, *view.getViewProxy());
  return *proxy;
}

void look_from_the_front(const pqRenderView& view, const glm::dvec3& center) {
  const glm::dvec3 eye = center + glm::dvec3(500, -900, 300);
  const glm::dvec3 head(0, 0, 1);
  vtkSMProxy& camera = *view.getProxy();
  vtkSMPropertyHelper(&camera, "CameraPosition").Set(&eye.x, 3);
  vtkSMPropertyHelper(&camera, "CameraFocalPoint").Set(&center.x, 3);
  vtkSMPropertyHelper(&camera, "CameraViewUp").Set(&head.x, 3);
  camera.UpdateVTKObjects();
  view.getRenderViewProxy()->ResetCamera(true);
}

void trace_shown(pqPipelineSource& source) {
  SM_SCOPED_TRACE(TraceText)
      .arg(("scanView = GetActiveViewOrCreate('RenderView')\n"
            "scanDisplay = Show(FindSource('" +
            source.getSMName().toStdString() +
            "'), scanView)\n"
            "scanDisplay.SetRepresentationType('Slice')\n"
            "scanView.ResetCamera()")
               .c_str())
      .arg("comment", "the scan in a view");
}

}  // namespace palpate::plugin
