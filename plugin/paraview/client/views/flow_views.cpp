#include "plugin/paraview/client/views/flow_views.h"

#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkProperty.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "io/fields/volume_fields.h"
#include "plugin/paraview/client/views/overlay_lines.h"

namespace palpate::plugin {
namespace {

constexpr int arrows_across = 28;
constexpr double flow_least_part = 0.03;  // of the fastest: slower is not drawn

}  // namespace

struct FlowViews::One : OverlayLines {
  explicit One(const ClinicalView& of) : OverlayLines(of, {0.35, 0.8, 1}) { actor->GetProperty()->SetLineWidth(1.5); }

  void draw(const io::FieldSource& field, double fastest);
};

void FlowViews::One::draw(const io::FieldSource& field, double fastest) {
  const glm::dvec2 half = slice->half_size_mm();
  const double step = 2 * std::max(half.x, half.y) / arrows_across;
  const Sight& sight = slice->sight();
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  const auto line = [&](const glm::dvec3& from, const glm::dvec3& to) {
    const vtkIdType ends[] = {points->InsertNextPoint(&from.x), points->InsertNextPoint(&to.x)};
    cells->InsertNextCell(2, ends);
  };
  for (double up = -half.y + step / 2; up < half.y; up += step) {
    for (double right = -half.x + step / 2; right < half.x; right += step) {
      const glm::dvec3 place = slice->place_at({right, up});
      const io::Sample sample = field.sample(place, io::FieldSet::vector);
      if (!sample.inside) continue;
      const glm::dvec3 in_plane = sample.vector - glm::dot(sample.vector, sight.along) * sight.along;
      const double speed = glm::length(in_plane);
      if (speed < flow_least_part * fastest) continue;
      const glm::dvec3 way = in_plane / speed;
      const double length = step * (0.25 + 0.75 * std::min(speed / fastest, 1.0));
      const glm::dvec3 tip = place + 0.5 * length * way;
      const glm::dvec3 across = glm::cross(way, sight.along);
      line(place - 0.5 * length * way, tip);
      for (const double side : {-1.0, 1.0}) line(tip, tip - 0.3 * length * way + side * 0.18 * length * across);
    }
  }
  lines->SetPoints(points);
  lines->SetLines(cells);
  actor->SetVisibility(points->GetNumberOfPoints() > 0 ? 1 : 0);
}

FlowViews::FlowViews(OpenViews& views)
    : following_(views.follow(
          Layer::image, [this](const auto& open) { set_views(open); }, [this](SliceView& slice) { show(slice); })) {}
FlowViews::~FlowViews() = default;

void FlowViews::set_views(const std::vector<ClinicalView>& views) {
  views_.clear();
  for (const ClinicalView& view : views) {
    if (view.slice) views_.push_back(std::make_unique<One>(view));
  }
}

void FlowViews::set_volume(const std::shared_ptr<const io::Volume>& volume) {
  field_.reset();
  fastest_ = 0;
  if (volume && volume->vectors) {
    field_ = std::make_shared<const io::VolumeFields>(volume, io::FieldSet::vector, 1,
                                                      io::FieldOptions{.brick_bytes = 0, .background = false});
    fastest_ = io::statistics(*volume).maximum;  // its values are the speeds
  }
  for (const auto& one : views_) {
    if (!one->slice || !one->view) continue;
    show(*one->slice);
    one->view->render();
  }
}

void FlowViews::show(SliceView& slice) {
  for (const auto& one : views_) {
    if (one->slice != &slice) continue;
    if (field_ && fastest_ > 0) {
      one->draw(*field_, fastest_);
    } else {
      one->actor->VisibilityOff();
    }
  }
}

}  // namespace palpate::plugin
