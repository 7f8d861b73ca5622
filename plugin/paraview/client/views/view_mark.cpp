#include "plugin/paraview/client/views/view_mark.h"

#include <pqActiveObjects.h>
#include <pqRenderView.h>
#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCoordinate.h>
#include <vtkPVRenderView.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>

namespace palpate::plugin {

ViewMark::ViewMark(pqRenderView& view)
    : view_(view),
      renderer_(
          vtkPVRenderView::SafeDownCast(view.getRenderViewProxy()->GetClientSideView())->GetNonCompositedRenderer()) {
  vtkNew<vtkPoints> corners;
  vtkNew<vtkCellArray> lines;
  constexpr double edges[][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const auto& [x, y] : edges) corners->InsertNextPoint(x, y, 0);
  lines->InsertNextCell({0, 1, 2, 3, 0});
  vtkNew<vtkPolyData> shape;
  shape->SetPoints(corners);
  shape->SetLines(lines);
  vtkNew<vtkCoordinate> parts_of_view;
  parts_of_view->SetCoordinateSystemToNormalizedViewport();
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(shape);
  mapper->SetTransformCoordinate(parts_of_view);
  frame_->SetMapper(mapper);
  frame_->GetProperty()->SetColor(0.34, 0.71, 0.91);
  frame_->GetProperty()->SetLineWidth(4);  // half of it is outside
  renderer_->AddActor(frame_);
  connect(&pqActiveObjects::instance(), QOverload<pqView*>::of(&pqActiveObjects::viewChanged), this,
          [this] { follow(); });
  frame_->SetVisibility(pqActiveObjects::instance().activeView() == &view_ ? 1 : 0);
}

ViewMark::~ViewMark() {
  renderer_->RemoveActor(frame_);
}

void ViewMark::follow() {
  const int marked = pqActiveObjects::instance().activeView() == &view_ ? 1 : 0;
  if (marked == frame_->GetVisibility()) return;
  frame_->SetVisibility(marked);
  view_.render();
}

}  // namespace palpate::plugin
