#include "plugin/paraview/client/views/volume_pick.h"

#include <vtkBoxRepresentation.h>
#include <vtkCommand.h>
#include <vtkPVRenderView.h>
#include <vtkPropCollection.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <utility>

namespace palpate::plugin {
namespace {

constexpr float pick_before_paraview = 10;

}  // namespace

VolumePick::VolumePick(vtkPVRenderView& view, Ray ray)
    : view_(view),
      ray_(std::move(ray)),
      interactor_(view.GetInteractor()),
      events_(interactor_,
              {vtkCommand::LeftButtonPressEvent, vtkCommand::MouseMoveEvent, vtkCommand::LeftButtonReleaseEvent},
              pick_before_paraview, [this](unsigned long event) { return handle(event); }) {}

/// Of a crop box, or of another box that ParaView shows.
bool VolumePick::is_on_handle() const {
  const int* const at = interactor_->GetEventPosition();
  vtkPropCollection& props = *view_.GetRenderer()->GetViewProps();
  vtkCollectionSimpleIterator each;
  props.InitTraversal(each);
  while (vtkProp* const prop = props.GetNextProp(each)) {
    auto* const box = vtkBoxRepresentation::SafeDownCast(prop);
    if (!box || !box->GetVisibility()) continue;
    const int state = box->ComputeInteractionState(at[0], at[1]);
    if (state >= vtkBoxRepresentation::MoveF0 && state <= vtkBoxRepresentation::MoveF5) return true;
  }
  return false;
}

bool VolumePick::handle(unsigned long event) {
  const glm::dvec3 near = place_at(0), far = place_at(1);
  switch (event) {
    case vtkCommand::LeftButtonPressEvent:
      if (interactor_->GetControlKey() || interactor_->GetShiftKey() || is_on_handle()) return false;  // ParaView's
      return picking_ = ray_(Pick::pressed, near, far);
    case vtkCommand::MouseMoveEvent:
      return picking_ && ray_(Pick::moved, near, far);
    default:
      return std::exchange(picking_, false) && ray_(Pick::let_go, near, far);
  }
}

/// `depth` along the ray under the pointer: 0 is nearest to the eye, 1 farthest.
glm::dvec3 VolumePick::place_at(double depth) const {
  const int* const at = interactor_->GetEventPosition();
  vtkRenderer& renderer = *view_.GetRenderer();
  renderer.SetDisplayPoint(at[0], at[1], depth);
  renderer.DisplayToWorld();
  const double* const world = renderer.GetWorldPoint();
  return glm::dvec3(world[0], world[1], world[2]) / world[3];
}

}  // namespace palpate::plugin
