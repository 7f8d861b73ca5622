#pragma once

/// A radiologist's mouse and keys in a slice view: left drag for the window, the wheel and the bar at the right edge
/// for the slice, 1 to 9 for windows, I for the texts.

#include <vtkSmartPointer.h>

#include <array>

#include "plugin/paraview/client/views/event_watch.h"
#include "plugin/paraview/client/views/slice_view.h"

class vtkRenderWindowInteractor;

namespace palpate::plugin {

/// Handles its own events before ParaView's interaction, and leaves the others (zoom, pan) to it.
class SliceMouse {
 public:
  SliceMouse(SliceView& owner, vtkRenderWindowInteractor& interactor);
  SliceMouse(const SliceMouse&) = delete;
  SliceMouse& operator=(const SliceMouse&) = delete;

 private:
  bool handle(unsigned long event);
  bool press();
  bool move();
  bool let_go();
  bool key(bool pressed);
  bool pick(Pick what);
  void drag_to(int x, int y);

  enum class Drag { none, window, pick, scroll };

  SliceView& owner_;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor_;
  Drag drag_ = Drag::none;
  std::array<int, 2> from_{};
  Window start_;
  EventWatch events_;
};

}  // namespace palpate::plugin
