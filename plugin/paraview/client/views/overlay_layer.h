#pragma once

/// A layer in front of everything else in a view, with its own depth buffer: neither slices nor surfaces cover it.

#include <vtkSmartPointer.h>

#include "plugin/paraview/client/views/event_watch.h"

class vtkCamera;
class vtkPVRenderView;
class vtkRenderWindow;
class vtkRenderer;

namespace palpate::plugin {

class OverlayLayer {
 public:
  explicit OverlayLayer(vtkPVRenderView& view);
  OverlayLayer(const OverlayLayer&) = delete;
  OverlayLayer& operator=(const OverlayLayer&) = delete;
  ~OverlayLayer();

  vtkRenderer& renderer() const { return *renderer_; }

 private:
  void follow_camera();

  vtkSmartPointer<vtkRenderWindow> window_;
  vtkSmartPointer<vtkCamera> camera_;
  vtkSmartPointer<vtkRenderer> renderer_;
  EventWatch before_render_;
};

}  // namespace palpate::plugin
