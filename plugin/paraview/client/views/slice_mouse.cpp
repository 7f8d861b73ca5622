#include "plugin/paraview/client/views/slice_mouse.h"

#include <pqRenderView.h>
#include <vtkCommand.h>
#include <vtkRenderWindowInteractor.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "plugin/paraview/client/views/slice_overlay.h"
#include "plugin/paraview/client/views/slice_scroll_bar.h"

namespace palpate::plugin {
namespace {

constexpr float before_paraview = 10;

}  // namespace

SliceMouse::SliceMouse(SliceView& owner, vtkRenderWindowInteractor& interactor)
    : owner_(owner),
      interactor_(&interactor),
      events_(&interactor,
              {vtkCommand::LeftButtonPressEvent, vtkCommand::LeftButtonReleaseEvent, vtkCommand::MouseMoveEvent,
               vtkCommand::MouseWheelForwardEvent, vtkCommand::MouseWheelBackwardEvent, vtkCommand::LeaveEvent,
               vtkCommand::KeyPressEvent, vtkCommand::CharEvent},
              before_paraview, [this](unsigned long event) { return handle(event); }) {}

/// Whether the event was used.
bool SliceMouse::handle(unsigned long event) {
  switch (event) {
    case vtkCommand::LeftButtonPressEvent:
      return press();
    case vtkCommand::LeftButtonReleaseEvent:
      return let_go();
    case vtkCommand::MouseMoveEvent:
      return move();
    case vtkCommand::LeaveEvent:
      owner_.pointer_.reset();
      if (owner_.window_->pointed) owner_.window_->pointed(std::nullopt);
      if (owner_.overlay_->set_pointer({})) owner_.view_.render();
      return false;
    case vtkCommand::KeyPressEvent:
    case vtkCommand::CharEvent:
      return key(event == vtkCommand::KeyPressEvent);
    case vtkCommand::MouseWheelForwardEvent:
    case vtkCommand::MouseWheelBackwardEvent:
      owner_.leaf(event == vtkCommand::MouseWheelForwardEvent ? 1 : -1);
      return true;
    default:
      return false;
  }
}

bool SliceMouse::press() {
  const int* const at = interactor_->GetEventPosition();
  if (owner_.bar_->is_under(at[0])) {
    drag_ = Drag::scroll;
    owner_.pointer_ = {at[0], at[1]};
    owner_.scroll_to(owner_.bar_->part_at(at[1]));
    return true;
  }
  if (interactor_->GetControlKey() || interactor_->GetShiftKey()) return false;
  if (pick(Pick::pressed)) {
    drag_ = Drag::pick;
    return true;
  }
  drag_ = Drag::window;
  from_ = {at[0], at[1]};
  start_ = owner_.window_->window;
  return true;
}

bool SliceMouse::let_go() {
  const Drag ended = std::exchange(drag_, Drag::none);
  if (ended == Drag::pick) pick(Pick::let_go);
  return ended != Drag::none;
}

bool SliceMouse::move() {
  const int* const at = interactor_->GetEventPosition();
  // First, so that the texts after a drag use the pointer's present position.
  owner_.pointer_ = {at[0], at[1]};
  if (drag_ == Drag::window || drag_ == Drag::scroll) {
    drag_ == Drag::window ? drag_to(at[0], at[1]) : owner_.scroll_to(owner_.bar_->part_at(at[1]));
    owner_.refresh_pointer();
    return true;
  }
  if (drag_ == Drag::pick) pick(Pick::moved);
  owner_.refresh_pointer();
  if (owner_.window_->pointed) owner_.window_->pointed(owner_.place_under(at[0], at[1]));
  if (interactor_->GetShiftKey() && drag_ == Drag::none && owner_.window_->pointed_with_shift) {
    owner_.window_->pointed_with_shift(owner_.place_under(at[0], at[1]));
  }
  return false;
}

/// Digits are not passed on: ParaView's own 3 would make the view stereoscopic.
bool SliceMouse::key(bool pressed) {
  const char key = interactor_->GetKeyCode();
  const bool modified = interactor_->GetControlKey() || interactor_->GetAltKey();
  if ((key == 'i' || key == 'I') && !modified) {
    if (pressed && owner_.window_->texts_toggled) owner_.window_->texts_toggled();
    return true;
  }
  if (key < '1' || key > '9' || !owner_.window_->digit_pressed) return false;
  if (pressed) owner_.window_->digit_pressed(key - '0');
  return true;
}

/// Whether places are being picked.
bool SliceMouse::pick(Pick what) {
  if (!owner_.window_->pick) return false;
  const int* const at = interactor_->GetEventPosition();
  const auto pick = owner_.window_->pick;  // picking may end in the call
  pick(what, owner_.place_under(at[0], at[1]));
  return true;
}

/// To the right wider, up brighter; a drag over the view's width doubles the window or halves it.
void SliceMouse::drag_to(int x, int y) {
  if (!owner_.window_->gray_map) return;
  const int* const size = interactor_->GetSize();
  const double right = static_cast<double>(x - from_[0]) / std::max(size[0], 1);
  const double up = static_cast<double>(y - from_[1]) / std::max(size[1], 1);
  Window& window = owner_.window_->window;
  window.width = std::max(start_.width * std::exp2(2 * right), 1e-3);
  window.level = start_.level - up * start_.width;
  set_window(*owner_.window_->gray_map, window);
  if (owner_.window_->changed) owner_.window_->changed();
}

}  // namespace palpate::plugin
