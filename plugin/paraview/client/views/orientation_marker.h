#pragma once

/// The patient's orientation in a view of the volume: a cross with R, L, A, P, H and F at its ends. ParaView's own
/// marker shows fixed letters X, Y and Z.

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <array>

#include "plugin/paraview/client/views/event_watch.h"

class vtkActor2D;
class vtkPVRenderView;
class vtkPoints;
class vtkRenderer;
class vtkTextActor;

namespace palpate::plugin {

/// In the view's lower left corner; rotates with the camera. Arms that point away are dim.
class OrientationMarker {
 public:
  explicit OrientationMarker(vtkPVRenderView& view);
  OrientationMarker(const OrientationMarker&) = delete;
  OrientationMarker& operator=(const OrientationMarker&) = delete;
  ~OrientationMarker();

 private:
  void turn();

  vtkSmartPointer<vtkRenderer> renderer_;
  vtkPVRenderView& view_;
  std::array<vtkNew<vtkTextActor>, 6> letters_;
  vtkNew<vtkPoints> ends_;
  vtkNew<vtkActor2D> arms_;
  EventWatch before_render_;
};

}  // namespace palpate::plugin
