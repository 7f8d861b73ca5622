#include "plugin/paraview/client/views/crop_box.h"

#include <pqRenderView.h>
#include <vtkBoxRepresentation.h>
#include <vtkBoxWidget2.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkPVRenderView.h>
#include <vtkPlane.h>
#include <vtkPlaneCollection.h>
#include <vtkPlanes.h>
#include <vtkProperty.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>

namespace palpate::plugin {

CropBox::CropBox(pqRenderView& view, const double bounds[6]) : view_(&view) {
  auto& client = *vtkPVRenderView::SafeDownCast(view.getRenderViewProxy()->GetClientSideView());
  double box[6];
  for (int n = 0; n < 6; ++n) box[n] = bounds[n];
  shape_->SetPlaceFactor(1);
  shape_->PlaceWidget(box);
  shape_->SetInsideOut(1);  // what is inside stays
  constexpr double handle_pixels = 9;
  shape_->SetHandleSize(handle_pixels);
  shape_->GetOutlineProperty()->SetColor(0.7, 0.7, 0.7);
  shape_->GetHandleProperty()->SetColor(0.34, 0.71, 0.91);
  widget_->SetInteractor(client.GetInteractor());
  widget_->SetDefaultRenderer(client.GetRenderer());
  widget_->SetCurrentRenderer(client.GetRenderer());
  widget_->SetRepresentation(shape_);
  widget_->RotationEnabledOff();
  for (int side = 0; side < 6; ++side) planes_->AddItem(vtkNew<vtkPlane>());
  dragged_->SetClientData(this);
  dragged_->SetCallback([](vtkObject*, unsigned long, void* self, void*) { static_cast<CropBox*>(self)->follow(); });
  widget_->AddObserver(vtkCommand::InteractionEvent, dragged_);
  follow();
}

CropBox::~CropBox() {
  widget_->RemoveAllObservers();
  if (view_) widget_->Off();
}

void CropBox::set_visible(bool visible) {
  if (visible != (widget_->GetEnabled() != 0)) widget_->SetEnabled(visible ? 1 : 0);
}

void CropBox::follow() {
  vtkNew<vtkPlanes> sides;
  shape_->GetPlanes(sides);
  for (int side = 0; side < sides->GetNumberOfPlanes(); ++side) {
    vtkPlane& of = *sides->GetPlane(side);
    vtkPlane& to = *planes_->GetItem(side);
    to.SetOrigin(of.GetOrigin());
    to.SetNormal(of.GetNormal());
  }
  if (view_) view_->render();
}

}  // namespace palpate::plugin
