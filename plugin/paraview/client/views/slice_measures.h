#pragma once

/// Lengths and angles measured with the mouse in a slice: L for a length, A for an angle; the delete key removes the
/// latest one. Each belongs to its slice, and is deleted with the view. The lines are our own, because VTK's widgets
/// would also take every click beside them.

#include <vtkSmartPointer.h>

#include <QString>

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "plugin/paraview/client/views/event_watch.h"
#include "plugin/paraview/client/views/slice_view.h"

class vtkRenderWindowInteractor;

namespace palpate::plugin {

class OverlayLayer;

/// The measurement between two places (a length) or three (the angle at the second), mm in the patient: "23.4 mm",
/// "45.0°".
QString measured_text(std::span<const glm::dvec3> places);

class SliceMeasures {
 public:
  /// While something is to be measured, this takes the mouse before the slice and the simulated stylus do.
  SliceMeasures(SliceView& slice, pqRenderView& view, std::shared_ptr<SharedWindow> window);
  SliceMeasures(const SliceMeasures&) = delete;
  SliceMeasures& operator=(const SliceMeasures&) = delete;
  ~SliceMeasures();

  /// To be called when the view shows another slice.
  void show_slice();

 private:
  struct Drawn;
  bool handle(unsigned long event);
  bool key(bool pressed);
  bool press();
  bool move();
  bool let_go();
  void fix_point();
  void drop_unfinished();
  void remove_last();
  std::size_t points_needed() const;
  glm::dvec3 under_pointer() const;
  Drawn& add();

  SliceView& slice_;
  pqRenderView& view_;
  std::shared_ptr<SharedWindow> window_;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor_;
  std::unique_ptr<OverlayLayer> layer_;  // made for the first measurement
  std::vector<std::unique_ptr<Drawn>> drawn_;
  bool unfinished_ = false;  // of the last measurement
  bool pressed_ = false;
  std::array<int, 2> pressed_at_{};
  EventWatch events_;
};

}  // namespace palpate::plugin
