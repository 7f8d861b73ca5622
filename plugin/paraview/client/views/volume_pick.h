#pragma once

/// The left button in a 3D view, as a ray through the patient.

#include <vtkSmartPointer.h>

#include <functional>
#include <glm/vec3.hpp>

#include "plugin/paraview/client/views/event_watch.h"
#include "plugin/paraview/client/views/slice_view.h"

class vtkPVRenderView;
class vtkRenderWindowInteractor;

namespace palpate::plugin {

class VolumePick {
 public:
  /// Gets the near and far ends (mm) of the visible ray under the pointer. Returns whether it takes the button; the
  /// view is then not rotated.
  using Ray = std::function<bool(Pick, const glm::dvec3& near, const glm::dvec3& far)>;

  VolumePick(vtkPVRenderView& view, Ray ray);
  VolumePick(const VolumePick&) = delete;
  VolumePick& operator=(const VolumePick&) = delete;

 private:
  bool is_on_handle() const;
  bool handle(unsigned long event);
  glm::dvec3 place_at(double depth) const;

  vtkPVRenderView& view_;
  Ray ray_;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor_;
  bool picking_ = false;
  EventWatch events_;
};

}  // namespace palpate::plugin
