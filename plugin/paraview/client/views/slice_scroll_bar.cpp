#include "plugin/paraview/client/views/slice_scroll_bar.h"

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkPVRenderView.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>

namespace palpate::plugin {
namespace {

void make_box(vtkPoints& corners, vtkActor2D& actor, double gray, double opacity) {
  corners.SetNumberOfPoints(4);
  for (vtkIdType n = 0; n < 4; ++n) corners.SetPoint(n, 0, 0, 0);
  vtkNew<vtkCellArray> box;
  box->InsertNextCell({0, 1, 2, 3});
  vtkNew<vtkPolyData> shape;
  shape->SetPoints(&corners);
  shape->SetPolys(box);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(shape);
  actor.SetMapper(mapper);
  actor.GetProperty()->SetColor(gray, gray, gray);
  actor.GetProperty()->SetOpacity(opacity);
}

void set_box(vtkPoints& corners, double left, double below, double right, double above) {
  corners.SetPoint(0, left, below, 0);
  corners.SetPoint(1, right, below, 0);
  corners.SetPoint(2, right, above, 0);
  corners.SetPoint(3, left, above, 0);
  corners.Modified();
}

}  // namespace

SliceScrollBar::SliceScrollBar(vtkPVRenderView& view)
    : renderer_(view.GetNonCompositedRenderer()),
      before_render_(renderer_, vtkCommand::StartEvent, [this] { place(); }) {
  make_box(*track_points_, *track_, 0.25, 0.6);
  make_box(*handle_points_, *handle_, 0.75, 0.9);
  renderer_->AddActor(track_);
  renderer_->AddActor(handle_);
}

SliceScrollBar::~SliceScrollBar() {
  renderer_->RemoveActor(track_);
  renderer_->RemoveActor(handle_);
}

void SliceScrollBar::set(int n, int of) {
  n_ = n;
  of_ = std::max(of, 1);
}

void SliceScrollBar::set_visible(bool visible) {
  track_->SetVisibility(visible ? 1 : 0);
  handle_->SetVisibility(visible ? 1 : 0);
}

int SliceScrollBar::width() const {
  constexpr int least = 9;
  constexpr double of_view = 0.016;
  return std::max(least, static_cast<int>(of_view * renderer_->GetSize()[0]));
}

double SliceScrollBar::handle_height() const {
  constexpr double least = 18;
  const double height = renderer_->GetSize()[1];
  return std::min(std::max(height / of_, least), height);
}

bool SliceScrollBar::is_under(int x) const {
  return track_->GetVisibility() != 0 && x >= renderer_->GetSize()[0] - width();
}

double SliceScrollBar::part_at(int y) const {
  const double way = renderer_->GetSize()[1] - handle_height();
  return way > 0 ? std::clamp((y - handle_height() / 2) / way, 0.0, 1.0) : 0;
}

void SliceScrollBar::place() {
  const double right = renderer_->GetSize()[0], height = renderer_->GetSize()[1];
  const double left = right - width();
  set_box(*track_points_, left, 0, right, height);
  const double below = of_ > 1 ? (height - handle_height()) * n_ / (of_ - 1) : 0;
  set_box(*handle_points_, left + 2, below, right - 1, below + handle_height());
}

}  // namespace palpate::plugin
