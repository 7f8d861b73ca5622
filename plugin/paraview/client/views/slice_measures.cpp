#include "plugin/paraview/client/views/slice_measures.h"

#include <pqRenderView.h>
#include <vtkActor.h>
#include <vtkBillboardTextActor3D.h>
#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkPVRenderView.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <utility>

#include "plugin/paraview/client/views/overlay_layer.h"

namespace palpate::plugin {
namespace {

constexpr float before_all = 30;
constexpr double green[3] = {0.45, 1, 0.6};
constexpr double click_pixels = 4;  // a press that moves less is a click

}  // namespace

QString measured_text(std::span<const glm::dvec3> places) {
  if (places.size() == 2) return QStringLiteral("%1 mm").arg(glm::distance(places[0], places[1]), 0, 'f', 1);
  const glm::dvec3 a = places[0] - places[1], b = places[2] - places[1];
  const double radians = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
  return QStringLiteral("%1°").arg(radians * 180 / std::numbers::pi, 0, 'f', 1);
}

struct SliceMeasures::Drawn {
  Drawn(vtkRenderer& of, int on_slice) : renderer(&of), slice(on_slice) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(shape);
    actor->SetMapper(mapper);
    actor->PickableOff();
    actor->GetProperty()->SetLighting(false);
    actor->GetProperty()->SetColor(green[0], green[1], green[2]);
    actor->GetProperty()->SetLineWidth(2);
    actor->GetProperty()->SetPointSize(6);
    text->SetDisplayOffset(10, 6);
    text->PickableOff();
    vtkTextProperty& style = *text->GetTextProperty();
    style.SetFontSize(14);
    style.SetBold(1);
    style.SetColor(green[0], green[1], green[2]);
    style.SetBackgroundColor(0, 0, 0);
    style.SetBackgroundOpacity(0.6);
    renderer->AddActor(actor);
    renderer->AddActor(text);
  }
  Drawn(const Drawn&) = delete;
  Drawn& operator=(const Drawn&) = delete;
  ~Drawn() {
    renderer->RemoveActor(actor);
    renderer->RemoveActor(text);
  }

  void draw() {
    vtkNew<vtkPoints> ends;
    vtkNew<vtkCellArray> lines, marks;
    for (const glm::dvec3& place : places) {
      const vtkIdType end = ends->InsertNextPoint(&place.x);
      marks->InsertNextCell(1, &end);
      if (end > 0) lines->InsertNextCell({end - 1, end});
    }
    shape->Initialize();
    shape->SetPoints(ends);
    shape->SetLines(lines);
    shape->SetVerts(marks);
    if (places.size() < 2) return;
    const glm::dvec3& at = places[1];  // of an angle its corner
    text->SetInput(measured_text(places).toUtf8().constData());
    text->SetPosition(at.x, at.y, at.z);
  }
  void set_visible(bool visible) {
    actor->SetVisibility(visible ? 1 : 0);
    text->SetVisibility(visible ? 1 : 0);
  }

  vtkSmartPointer<vtkRenderer> renderer;
  int slice;
  std::vector<glm::dvec3> places;
  vtkNew<vtkPolyData> shape;
  vtkNew<vtkActor> actor;
  vtkNew<vtkBillboardTextActor3D> text;
};

SliceMeasures::SliceMeasures(SliceView& slice, pqRenderView& view, std::shared_ptr<SharedWindow> window)
    : slice_(slice),
      view_(view),
      window_(std::move(window)),
      interactor_(view.getRenderViewProxy()->GetInteractor()),
      events_(interactor_,
              {vtkCommand::LeftButtonPressEvent, vtkCommand::LeftButtonReleaseEvent, vtkCommand::MouseMoveEvent,
               vtkCommand::KeyPressEvent, vtkCommand::CharEvent},
              before_all, [this](unsigned long event) { return handle(event); }) {}

SliceMeasures::~SliceMeasures() = default;

bool SliceMeasures::handle(unsigned long event) {
  switch (event) {
    case vtkCommand::LeftButtonPressEvent:
      return press();
    case vtkCommand::LeftButtonReleaseEvent:
      return let_go();
    case vtkCommand::MouseMoveEvent:
      return move();
    default:
      return key(event == vtkCommand::KeyPressEvent);
  }
}

bool SliceMeasures::key(bool pressed) {
  const char* const symbol = interactor_->GetKeySym();
  const std::string name = symbol ? symbol : "";
  if (interactor_->GetControlKey() || interactor_->GetAltKey()) return false;
  const auto want = [&](Measure what) {
    if (pressed && window_->measure_wanted) window_->measure_wanted(window_->measure == what ? Measure::none : what);
    return true;
  };
  if (name == "l" || name == "L") return want(Measure::ruler);
  if (name == "a" || name == "A") return want(Measure::angle);
  if (name == "Escape") {
    if (pressed && window_->measure != Measure::none && window_->measure_wanted) {
      window_->measure_wanted(Measure::none);
    }
    return false;  // it releases the force, too
  }
  if (name != "Delete" && name != "BackSpace") return false;
  if (pressed) remove_last();
  return true;
}

std::size_t SliceMeasures::points_needed() const {
  return window_->measure == Measure::angle ? 3 : 2;
}

glm::dvec3 SliceMeasures::under_pointer() const {
  const int* const at = interactor_->GetEventPosition();
  return slice_.place_under(at[0], at[1]);
}

SliceMeasures::Drawn& SliceMeasures::add() {
  if (!layer_) {
    layer_ =
        std::make_unique<OverlayLayer>(*vtkPVRenderView::SafeDownCast(view_.getRenderViewProxy()->GetClientSideView()));
  }
  drawn_.push_back(std::make_unique<Drawn>(layer_->renderer(), slice_.slice()));
  return *drawn_.back();
}

bool SliceMeasures::press() {
  drop_unfinished();
  if (window_->measure == Measure::none) return false;
  const int* const at = interactor_->GetEventPosition();
  pressed_ = true;
  pressed_at_ = {at[0], at[1]};
  if (!unfinished_) {
    unfinished_ = true;
    add().places = {under_pointer(), under_pointer()};
  }
  move();
  return true;
}

/// The last place follows the pointer.
bool SliceMeasures::move() {
  drop_unfinished();
  if (window_->measure == Measure::none || !unfinished_) return false;
  drawn_.back()->places.back() = under_pointer();
  drawn_.back()->draw();
  view_.render();
  return pressed_;
}

bool SliceMeasures::let_go() {
  if (!std::exchange(pressed_, false)) return false;
  if (!unfinished_) return true;
  const int* const at = interactor_->GetEventPosition();
  const bool dragged = std::hypot(at[0] - pressed_at_[0], at[1] - pressed_at_[1]) > click_pixels;
  const auto& places = drawn_.back()->places;
  const bool first_click = places.size() == 2 && places[0] == places[1];
  if (dragged || !first_click) fix_point();
  return true;
}

void SliceMeasures::fix_point() {
  auto& places = drawn_.back()->places;
  if (places.size() < points_needed()) {
    places.push_back(places.back());
    return;
  }
  unfinished_ = false;
  if (window_->measure_wanted) window_->measure_wanted(Measure::none);
}

/// Something else is measured by now, or nothing.
void SliceMeasures::drop_unfinished() {
  if (!unfinished_) return;
  const bool other_slice = drawn_.back()->slice != slice_.slice();
  if (window_->measure != Measure::none && !other_slice && drawn_.back()->places.size() <= points_needed()) return;
  unfinished_ = false;
  drawn_.pop_back();
  view_.render();
}

void SliceMeasures::remove_last() {
  const auto last =
      std::find_if(drawn_.rbegin(), drawn_.rend(), [this](const auto& one) { return one->slice == slice_.slice(); });
  if (last == drawn_.rend()) return;
  if (last == drawn_.rbegin()) unfinished_ = false;
  drawn_.erase(std::next(last).base());
  view_.render();
}

void SliceMeasures::show_slice() {
  drop_unfinished();
  for (const auto& one : drawn_) one->set_visible(one->slice == slice_.slice());
}

}  // namespace palpate::plugin
