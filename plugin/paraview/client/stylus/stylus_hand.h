#pragma once

/// The simulated stylus in one view: drag its handle and the hand goes there, in the view's plane through the proxy;
/// the wheel goes along the view, arrow keys and Page Up and Down step. What is not on the handle stays the view's.

#include <memory>

#include "plugin/paraview/client/panel/session_controller.h"

class vtkPVRenderView;

namespace palpate::plugin {

class StylusHand {
 public:
  StylusHand(SessionController& touching, vtkPVRenderView& view);
  StylusHand(const StylusHand&) = delete;
  StylusHand& operator=(const StylusHand&) = delete;
  ~StylusHand();

  bool is_dragging() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate::plugin
