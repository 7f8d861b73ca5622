#include "plugin/paraview/tests/panel/drawn_lines.h"

#include <pqRenderView.h>
#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkSMRenderViewProxy.h>

#include <algorithm>
#include <functional>
#include <glm/common.hpp>

#include "plugin/paraview/tests/panel/panel_rig.h"

double DrawnLines::width_mm() const {
  const auto [least, most] = std::ranges::minmax(points, {}, &glm::dvec3::x);
  return most.x - least.x;
}

namespace {

/// Of each actor of that color.
void for_each_shape(const char* view, const QColor& color, const std::function<void(vtkActor&, vtkPolyData&)>& act) {
  vtkRendererCollection& layers = *render_view(view).getRenderViewProxy()->GetRenderWindow()->GetRenderers();
  for (int layer = 0; layer < layers.GetNumberOfItems(); ++layer) {
    vtkActorCollection& actors = *vtkRenderer::SafeDownCast(layers.GetItemAsObject(layer))->GetActors();
    for (int n = 0; n < actors.GetNumberOfItems(); ++n) {
      auto* const actor = vtkActor::SafeDownCast(actors.GetItemAsObject(n));
      const double* const of = actor->GetProperty()->GetColor();
      auto* const mapper = vtkPolyDataMapper::SafeDownCast(actor->GetMapper());
      const QColor now(qRound(255 * of[0]), qRound(255 * of[1]), qRound(255 * of[2]));
      if (now.rgb() == color.rgb() && mapper && mapper->GetInput()) act(*actor, *mapper->GetInput());
    }
  }
}

}  // namespace

std::vector<DrawnLines> lines_drawn_in(const char* view, const QColor& color) {
  std::vector<DrawnLines> drawn;
  for_each_shape(view, color, [&](vtkActor& actor, vtkPolyData& shape) {
    if (shape.GetNumberOfLines() == 0) return;
    DrawnLines& lines = drawn.emplace_back();
    lines.pixels = actor.GetProperty()->GetLineWidth();
    for (vtkIdType point = 0; point < shape.GetNumberOfPoints(); ++point) {
      const double* const at = shape.GetPoint(point);
      lines.points.emplace_back(at[0], at[1], at[2]);
    }
  });
  return drawn;
}

glm::dvec3 least_of_surface_in(const char* view, const QColor& color) {
  glm::dvec3 least(0);
  for_each_shape(view, color, [&](vtkActor&, vtkPolyData& shape) {
    if (shape.GetNumberOfPolys() == 0) return;
    const double* const bounds = shape.GetBounds();
    least = glm::min(least, glm::dvec3(bounds[0], bounds[2], bounds[4]));
  });
  return least;
}
