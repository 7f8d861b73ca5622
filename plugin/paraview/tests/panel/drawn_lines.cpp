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

#include "plugin/paraview/tests/panel/panel_rig.h"

double DrawnLines::width_mm() const {
  const auto [least, most] = std::ranges::minmax(points, {}, &glm::dvec3::x);
  return most.x - least.x;
}

std::vector<DrawnLines> lines_drawn_in(const char* view, const QColor& color) {
  std::vector<DrawnLines> drawn;
  vtkRendererCollection& layers = *render_view(view).getRenderViewProxy()->GetRenderWindow()->GetRenderers();
  for (int layer = 0; layer < layers.GetNumberOfItems(); ++layer) {
    vtkActorCollection& actors = *vtkRenderer::SafeDownCast(layers.GetItemAsObject(layer))->GetActors();
    for (int n = 0; n < actors.GetNumberOfItems(); ++n) {
      auto* const actor = vtkActor::SafeDownCast(actors.GetItemAsObject(n));
      const double* const of = actor->GetProperty()->GetColor();
      auto* const mapper = vtkPolyDataMapper::SafeDownCast(actor->GetMapper());
      const QColor now(qRound(255 * of[0]), qRound(255 * of[1]), qRound(255 * of[2]));
      if (now.rgb() != color.rgb() || !mapper || !mapper->GetInput() || mapper->GetInput()->GetNumberOfLines() == 0)
        continue;
      DrawnLines& lines = drawn.emplace_back();
      lines.pixels = actor->GetProperty()->GetLineWidth();
      for (vtkIdType point = 0; point < mapper->GetInput()->GetNumberOfPoints(); ++point) {
        const double* const at = mapper->GetInput()->GetPoint(point);
        lines.points.emplace_back(at[0], at[1], at[2]);
      }
    }
  }
  return drawn;
}
