#include "plugin/paraview/client/views/path_views.h"

#include <pqRenderView.h>
#include <vtkPVRenderView.h>
#include <vtkSMRenderViewProxy.h>

namespace palpate::plugin {

void PathViews::set_views(const std::vector<ClinicalView>& views) {
  views_.clear();
  for (const ClinicalView& view : views) {
    auto& client = *vtkPVRenderView::SafeDownCast(view.view->getRenderViewProxy()->GetClientSideView());
    views_.push_back({view.kind, view.view, std::make_unique<PathGlyphs>(client, color_)});
  }
}

void PathViews::show(const std::vector<glm::dvec3>& path, bool passing) {
  for (const One& one : views_) {
    if (!one.view) continue;
    one.glyphs->show(path);
    if (!passing || one.kind != ViewKind::volume) one.view->render();
  }
}

}  // namespace palpate::plugin
