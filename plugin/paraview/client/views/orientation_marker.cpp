#include "plugin/paraview/client/views/orientation_marker.h"

#include <vtkActor2D.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkPVRenderView.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <glm/geometric.hpp>

#include "plugin/paraview/client/views/anatomy.h"

namespace palpate::plugin {
namespace {

constexpr std::array<glm::dvec3, 6> directions{glm::dvec3(1, 0, 0),  {-1, 0, 0}, {0, 1, 0},
                                               glm::dvec3(0, -1, 0), {0, 0, 1},  {0, 0, -1}};
constexpr double arm = 26, letter_at = 36, corner = 46;  // pixels

}  // namespace

OrientationMarker::OrientationMarker(vtkPVRenderView& view)
    : renderer_(view.GetNonCompositedRenderer()),
      view_(view),
      before_render_(renderer_, vtkCommand::StartEvent, [this] { turn(); }) {
  ends_->SetNumberOfPoints(directions.size());
  vtkNew<vtkCellArray> lines;
  for (vtkIdType axis = 0; axis < 3; ++axis) lines->InsertNextCell({2 * axis, 2 * axis + 1});
  vtkNew<vtkPolyData> cross;
  cross->SetPoints(ends_);
  cross->SetLines(lines);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(cross);
  arms_->SetMapper(mapper);
  arms_->GetProperty()->SetColor(0.6, 0.6, 0.6);
  arms_->GetProperty()->SetLineWidth(2);
  arms_->SetPosition(corner, corner);
  renderer_->AddActor(arms_);
  for (std::size_t n = 0; n < letters_.size(); ++n) {
    letters_[n]->SetInput(letters_of(directions[n]).c_str());
    vtkTextProperty& style = *letters_[n]->GetTextProperty();
    style.SetFontSize(14);
    style.SetBold(1);
    style.SetBackgroundColor(0, 0, 0);
    style.SetBackgroundOpacity(0.5);
    style.SetJustificationToCentered();
    style.SetVerticalJustificationToCentered();
    renderer_->AddActor(letters_[n]);
  }
}

OrientationMarker::~OrientationMarker() {
  renderer_->RemoveActor(arms_);
  for (const auto& letter : letters_) renderer_->RemoveActor(letter);
}

void OrientationMarker::turn() {
  vtkCamera& camera = *view_.GetActiveCamera();
  glm::dvec3 along, up;
  camera.GetDirectionOfProjection(&along.x);
  camera.GetViewUp(&up.x);
  const glm::dvec3 right = glm::normalize(glm::cross(along, up));
  const glm::dvec3 upright = glm::cross(right, along);
  for (std::size_t n = 0; n < directions.size(); ++n) {
    const double x = glm::dot(directions[n], right);
    const double y = glm::dot(directions[n], upright);
    ends_->SetPoint(static_cast<vtkIdType>(n), arm * x, arm * y, 0);
    letters_[n]->SetPosition(corner + letter_at * x, corner + letter_at * y);
    const double away = glm::dot(directions[n], along);
    const bool seen_end_on = away > 0.97;  // its letter would lie on that of the end towards the eye
    letters_[n]->SetVisibility(!seen_end_on);
    const double brightness = away > 0.3 ? 0.5 : 1;
    letters_[n]->GetTextProperty()->SetColor(brightness, 0.85 * brightness, 0.35 * brightness);
  }
  ends_->Modified();
}

}  // namespace palpate::plugin
