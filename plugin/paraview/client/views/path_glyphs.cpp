#include "plugin/paraview/client/views/path_glyphs.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPVRenderView.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include <QColor>

#include <initializer_list>

#include "plugin/paraview/client/views/overlay_layer.h"

namespace palpate::plugin {

struct PathGlyphs::Parts {
  explicit Parts(vtkPVRenderView& view) : layer(view) {}
  OverlayLayer layer;
  vtkNew<vtkPolyData> line, ends;
  vtkNew<vtkActor> line_actor, ends_actor;
};

PathGlyphs::PathGlyphs(vtkPVRenderView& view, const QColor& color) : parts_(std::make_unique<Parts>(view)) {
  const auto add = [&](vtkPolyData* data, vtkActor& actor) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(data);
    actor.SetMapper(mapper);
    actor.PickableOff();
    actor.VisibilityOff();
    actor.GetProperty()->SetLighting(false);
    actor.GetProperty()->SetColor(color.redF(), color.greenF(), color.blueF());
    parts_->layer.renderer().AddActor(&actor);
  };
  add(parts_->line, *parts_->line_actor);
  add(parts_->ends, *parts_->ends_actor);
  constexpr float line_pixels = 2, end_pixels = 8;
  parts_->line_actor->GetProperty()->SetLineWidth(line_pixels);
  parts_->ends_actor->GetProperty()->SetPointSize(end_pixels);
  parts_->ends_actor->GetProperty()->SetRenderPointsAsSpheres(true);
}

PathGlyphs::~PathGlyphs() = default;

void PathGlyphs::show(const std::vector<glm::dvec3>& path) {
  const bool seen = path.size() > 1;
  parts_->line_actor->SetVisibility(seen ? 1 : 0);
  parts_->ends_actor->SetVisibility(seen ? 1 : 0);
  if (!seen) return;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines, ends;
  lines->InsertNextCell(static_cast<int>(path.size()));
  for (const glm::dvec3& place : path) lines->InsertCellPoint(points->InsertNextPoint(place.x, place.y, place.z));
  for (const vtkIdType end : {vtkIdType{0}, static_cast<vtkIdType>(path.size()) - 1}) ends->InsertNextCell(1, &end);
  parts_->line->SetPoints(points);
  parts_->line->SetLines(lines);
  parts_->ends->SetPoints(points);
  parts_->ends->SetVerts(ends);
}

}  // namespace palpate::plugin
