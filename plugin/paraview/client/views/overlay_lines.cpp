#include "plugin/paraview/client/views/overlay_lines.h"

#include <vtkPVRenderView.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSMRenderViewProxy.h>

namespace palpate::plugin {

OverlayLines::OverlayLines(const ClinicalView& of, const std::array<double, 3>& color)
    : slice(of.slice),
      view(of.view),
      layer(*vtkPVRenderView::SafeDownCast(of.view->getRenderViewProxy()->GetClientSideView())) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(lines);
  actor->SetMapper(mapper);
  actor->PickableOff();
  actor->VisibilityOff();
  actor->GetProperty()->SetLighting(false);
  actor->GetProperty()->SetColor(color[0], color[1], color[2]);
  layer.renderer().AddActor(actor);
}

}  // namespace palpate::plugin
