#pragma once

/// Shows one view in place of all views of its tab, and back again.

#include <functional>

#include "plugin/paraview/client/views/event_watch.h"

class pqRenderView;
class vtkSMViewLayoutProxy;

namespace palpate::plugin {

/// The tab of a view; null if it is in none.
vtkSMViewLayoutProxy* layout_of(pqRenderView& view);
bool is_enlarged(pqRenderView& view);
/// Shows the view alone, or all views of its tab again.
void set_enlarged(pqRenderView& view, bool enlarged);

/// Double clicks in a view enlarge it and restore it. May be destroyed before or after its view.
class DoubleClickEnlarges {
 public:
  /// `changed` gets whether it is enlarged now.
  DoubleClickEnlarges(pqRenderView& view, std::function<void(bool)> changed);
  DoubleClickEnlarges(const DoubleClickEnlarges&) = delete;
  DoubleClickEnlarges& operator=(const DoubleClickEnlarges&) = delete;

 private:
  void change();

  pqRenderView& view_;
  std::function<void(bool)> changed_;
  EventWatch double_click_;
};

}  // namespace palpate::plugin
