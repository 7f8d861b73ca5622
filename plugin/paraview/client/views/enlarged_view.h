#pragma once

/// One view alone in the place of all views of its tab, and back again.

#include <functional>

#include "plugin/paraview/client/views/event_watch.h"

class pqRenderView;
class vtkSMViewLayoutProxy;

namespace palpate::plugin {

/// The tab in which a view stands; null where it stands in none.
vtkSMViewLayoutProxy* layout_of(pqRenderView& view);
bool is_enlarged(pqRenderView& view);
/// Alone, or all of its tab again.
void set_enlarged(pqRenderView& view, bool enlarged);

/// Double clicks in a view enlarge it and bring it back. May go before its view or after it.
class DoubleClickEnlarges {
 public:
  /// `changed` is told whether it is enlarged now.
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
