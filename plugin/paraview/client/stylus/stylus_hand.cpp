#include "plugin/paraview/client/stylus/stylus_hand.h"

#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkPVRenderView.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "plugin/paraview/client/views/event_watch.h"

namespace palpate::plugin {
namespace {

constexpr double grip_pixels = 16;
constexpr double wheel_mm = 1, key_mm = 1;
constexpr float before_all = 20;

}  // namespace

struct StylusHand::State {
  State(SessionController& touching_now, vtkPVRenderView& view_now)
      : session(touching_now),
        view(view_now),
        interactor(view_now.GetInteractor()),
        events(interactor,
               {vtkCommand::LeftButtonPressEvent, vtkCommand::LeftButtonReleaseEvent, vtkCommand::MouseMoveEvent,
                vtkCommand::MouseWheelForwardEvent, vtkCommand::MouseWheelBackwardEvent, vtkCommand::KeyPressEvent},
               before_all, [this](unsigned long event) { return handle(event); }) {}

  glm::dvec3 display_of(const glm::dvec3& place) const {
    vtkRenderer& renderer = *view.GetRenderer();
    renderer.SetWorldPoint(place.x, place.y, place.z, 1);
    renderer.WorldToDisplay();
    glm::dvec3 display;
    renderer.GetDisplayPoint(&display.x);
    return display;
  }
  /// The place in the patient under the pointer, at the depth of the dragged place.
  glm::dvec3 under_pointer() const {
    const int* const at = interactor->GetEventPosition();
    vtkRenderer& renderer = *view.GetRenderer();
    renderer.SetDisplayPoint(at[0] - grip[0], at[1] - grip[1], display_of(plane_through)[2]);
    renderer.DisplayToWorld();
    double world[4];
    renderer.GetWorldPoint(world);
    return glm::dvec3(world[0], world[1], world[2]) / world[3];
  }
  glm::dvec3 into_the_screen() const {
    glm::dvec3 along;
    view.GetActiveCamera()->GetDirectionOfProjection(&along.x);
    return along;
  }
  bool is_on_handle() {
    const int* const at = interactor->GetEventPosition();
    const SessionStatus& look = session.last();
    for (const glm::dvec3& part : {look.proxy_mm, look.probe_mm}) {
      const glm::dvec3 display = display_of(part);
      if (std::hypot(display.x - at[0], display.y - at[1]) > grip_pixels) continue;
      grip[0] = at[0] - display.x;
      grip[1] = at[1] - display.y;
      plane_through = part;
      return true;
    }
    return false;
  }
  void go(const glm::dvec3& place) {
    target = place;
    session.move_hand(place);
  }

  bool handle(unsigned long event) {
    if (!session.takes_mouse() || session.is_clutched() || !session.last().fresh) {
      dragging = false;
      return false;
    }
    switch (event) {
      case vtkCommand::LeftButtonPressEvent:
        if (!is_on_handle()) return false;
        dragging = true;
        go(plane_through);
        return true;
      case vtkCommand::LeftButtonReleaseEvent:
        if (!std::exchange(dragging, false)) return false;
        session.let_go();
        return true;
      case vtkCommand::MouseMoveEvent:
        if (!dragging) return false;
        go(under_pointer());
        return true;
      case vtkCommand::MouseWheelForwardEvent:
      case vtkCommand::MouseWheelBackwardEvent: {
        if (!dragging) return false;
        const double step = event == vtkCommand::MouseWheelForwardEvent ? wheel_mm : -wheel_mm;
        plane_through += step * into_the_screen();
        go(target + step * into_the_screen());
        return true;
      }
      case vtkCommand::KeyPressEvent:
        return step_by_key();
      default:
        return false;
    }
  }
  bool step_by_key() {
    const std::string key = interactor->GetKeySym() ? interactor->GetKeySym() : "";
    const glm::dvec3 along = into_the_screen();
    glm::dvec3 up;
    view.GetActiveCamera()->GetViewUp(&up.x);
    const glm::dvec3 right = glm::normalize(glm::cross(along, up));
    const glm::dvec3 upright = glm::cross(right, along);
    const std::pair<const char*, glm::dvec3> steps[] = {{"Left", -right},   {"Right", right}, {"Up", upright},
                                                        {"Down", -upright}, {"Prior", along}, {"Next", -along}};
    for (const auto& [name, step] : steps) {
      if (key != name) continue;
      // From where the hand wants to be, so that steps into a surface add up, in whichever view.
      session.move_hand(session.hand_mm() + key_mm * step);
      return true;
    }
    return false;
  }

  SessionController& session;
  vtkPVRenderView& view;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor;
  bool dragging = false;
  double grip[2] = {};
  glm::dvec3 plane_through{0}, target{1e9};
  EventWatch events;
};

StylusHand::StylusHand(SessionController& session, vtkPVRenderView& view)
    : state_(std::make_unique<State>(session, view)) {}

StylusHand::~StylusHand() = default;

}  // namespace palpate::plugin
