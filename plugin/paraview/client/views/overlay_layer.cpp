#include "plugin/paraview/client/views/overlay_layer.h"

#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkPVRenderView.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

namespace palpate::plugin {

OverlayLayer::OverlayLayer(vtkPVRenderView& view)
    : window_(view.GetRenderWindow()),
      camera_(view.GetActiveCamera()),
      renderer_(vtkSmartPointer<vtkRenderer>::New()),
      before_render_(window_, vtkCommand::StartEvent, [this] { follow_camera(); }) {
  const int layer = window_->GetNumberOfLayers();
  window_->SetNumberOfLayers(layer + 1);
  renderer_->SetLayer(layer);
  renderer_->InteractiveOff();
  window_->AddRenderer(renderer_);
}

OverlayLayer::~OverlayLayer() {
  window_->RemoveRenderer(renderer_);
}

/// Seen as the view is, but from as near and as far as its own things need.
void OverlayLayer::follow_camera() {
  vtkCamera& own = *renderer_->GetActiveCamera();
  own.DeepCopy(camera_);
  own.Modified();  // DeepCopy does not say so, and OpenGL's matrices stay those of where the camera was
  renderer_->ResetCameraClippingRange();
}

}  // namespace palpate::plugin
