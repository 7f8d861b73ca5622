#pragma once

/// A crosshair in each slice: its intersections with the slices of the other two views.

#include <memory>
#include <vector>

#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/views/clinical_views.h"

namespace palpate::plugin {

class ReferenceLines {
 public:
  explicit ReferenceLines(OpenViews& views);
  ~ReferenceLines();
  ReferenceLines(const ReferenceLines&) = delete;
  ReferenceLines& operator=(const ReferenceLines&) = delete;

  void set_visible(bool visible);

 private:
  struct One;
  void set_views(const std::vector<ClinicalView>& views);
  void refresh();

  std::vector<std::unique_ptr<One>> views_;
  bool visible_ = false;
  OpenViews::Following following_;
};

}  // namespace palpate::plugin
