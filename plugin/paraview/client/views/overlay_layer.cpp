#include "plugin/paraview/client/views/overlay_layer.h"

#include <vtkCallbackCommand.h>
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
      follow_(vtkSmartPointer<vtkCallbackCommand>::New()) {
  const int layer = window_->GetNumberOfLayers();
  window_->SetNumberOfLayers(layer + 1);
  renderer_->SetLayer(layer);
  renderer_->InteractiveOff();
  window_->AddRenderer(renderer_);
  follow_->SetClientData(this);
  follow_->SetCallback(
      [](vtkObject*, unsigned long, void* self, void*) { static_cast<OverlayLayer*>(self)->follow_camera(); });
  observer_ = window_->AddObserver(vtkCommand::StartEvent, follow_);
}

OverlayLayer::~OverlayLayer() {
  window_->RemoveObserver(observer_);
  window_->RemoveRenderer(renderer_);
}

/// Seen as the view is, but from as near and as far as its own things need.
void OverlayLayer::follow_camera() {
  renderer_->GetActiveCamera()->DeepCopy(camera_);
  renderer_->ResetCameraClippingRange();
}

}  // namespace palpate::plugin
