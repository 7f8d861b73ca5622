#include "plugin/paraview/client/views/enlarged_view.h"

#include <pqRenderView.h>
#include <pqUndoStack.h>
#include <vtkCommand.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSMTrace.h>
#include <vtkSMViewLayoutProxy.h>

#include <QTimer>

#include <utility>

namespace palpate::plugin {

vtkSMViewLayoutProxy* layout_of(pqRenderView& view) {
  return vtkSMViewLayoutProxy::FindLayout(view.getViewProxy());
}

bool is_enlarged(pqRenderView& view) {
  vtkSMViewLayoutProxy* const layout = layout_of(view);
  return layout && layout->GetMaximizedCell() >= 0 &&
         layout->GetMaximizedCell() == layout->GetViewLocation(view.getViewProxy());
}

void set_enlarged(pqRenderView& view, bool enlarged) {
  vtkSMViewLayoutProxy* const layout = layout_of(view);
  if (!layout) return;
  SCOPED_UNDO_EXCLUDE();  // undo is for what is edited
  SM_SCOPED_TRACE(BlockTraceItems);
  enlarged ? static_cast<void>(layout->MaximizeCell(layout->GetViewLocation(view.getViewProxy())))
           : layout->RestoreMaximizedState();
}

DoubleClickEnlarges::DoubleClickEnlarges(pqRenderView& view, std::function<void(bool)> changed)
    : view_(view),
      changed_(std::move(changed)),
      double_click_(view.getRenderViewProxy()->GetInteractor(), vtkCommand::LeftButtonDoubleClickEvent,
                    [this] { change(); }) {}

void DoubleClickEnlarges::change() {
  // Not while the view handles the click: it is taken out of its place.
  QTimer::singleShot(0, &view_, [view = &view_, changed = changed_] {
    set_enlarged(*view, !is_enlarged(*view));
    changed(is_enlarged(*view));
  });
}

}  // namespace palpate::plugin
