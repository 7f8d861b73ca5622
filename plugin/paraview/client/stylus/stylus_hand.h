#pragma once

/// Moves the simulated stylus in one view. Dragging its handle moves the hand in the view's plane through the proxy.
/// The wheel moves it along the view; arrow keys and Page Up and Down move it by steps. Events that are not on the
/// handle are left to the view.

#include <memory>

#include "plugin/paraview/client/model/session_controller.h"

class vtkPVRenderView;

namespace palpate::plugin {

class StylusHand {
 public:
  StylusHand(SessionController& session, vtkPVRenderView& view);
  StylusHand(const StylusHand&) = delete;
  StylusHand& operator=(const StylusHand&) = delete;
  ~StylusHand();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate::plugin
