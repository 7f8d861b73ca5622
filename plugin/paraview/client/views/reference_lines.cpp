#include "plugin/paraview/client/views/reference_lines.h"

#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkProperty.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "plugin/paraview/client/views/overlay_lines.h"

namespace palpate::plugin {

struct ReferenceLines::One : OverlayLines {
  explicit One(const ClinicalView& of) : OverlayLines(of, {0.34, 0.71, 0.91}) { actor->GetProperty()->SetOpacity(0.7); }
};

ReferenceLines::ReferenceLines(OpenViews& views)
    : following_(views.follow(
          Layer::outlines, [this](const auto& open) { set_views(open); }, [this](SliceView&) { refresh(); })) {}
ReferenceLines::~ReferenceLines() = default;

void ReferenceLines::set_views(const std::vector<ClinicalView>& views) {
  views_.clear();
  for (const ClinicalView& view : views) {
    if (view.slice) views_.push_back(std::make_unique<One>(view));
  }
  refresh();
}

void ReferenceLines::set_visible(bool visible) {
  visible_ = visible;
  refresh();
}

void ReferenceLines::refresh() {
  for (const auto& one : views_) {
    if (!one->slice || !one->view) continue;
    const bool was = one->actor->GetVisibility() != 0;
    one->actor->SetVisibility(visible_ ? 1 : 0);
    if (!visible_ && !was) continue;
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    const glm::dvec3& along = one->slice->sight().along;
    const glm::dvec3 middle = one->slice->place_at({0, 0});
    const glm::dvec2 half = one->slice->half_size_mm();
    const double reach = std::hypot(half.x, half.y);
    for (const auto& other : views_) {
      if (other == one || !other->slice) continue;
      const glm::dvec3& across = other->slice->sight().along;
      const glm::dvec3 line = glm::cross(along, across);
      const glm::dvec3 in_plane = across - glm::dot(across, along) * along;
      const double slope = glm::dot(in_plane, across);
      if (slope < 1e-6) continue;  // the two lie side by side
      const double off = glm::dot(other->slice->place_at({0, 0}) - middle, across);
      const glm::dvec3 at = middle + in_plane * (off / slope);
      const glm::dvec3 way = reach * glm::normalize(line);
      const glm::dvec3 from = at - way, to = at + way;
      const vtkIdType ends[] = {points->InsertNextPoint(&from.x), points->InsertNextPoint(&to.x)};
      cells->InsertNextCell(2, ends);
    }
    one->lines->SetPoints(points);
    one->lines->SetLines(cells);
    one->view->render();
  }
}

}  // namespace palpate::plugin
