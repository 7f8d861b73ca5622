#pragma once

/// A layer of a view's own above all else in it, with depths of its own: neither a slice nor a surface covers it.

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
