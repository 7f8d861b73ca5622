#pragma once

/// A crosshair in each slice: where the slices of the other two views cross it.

#include <memory>
#include <vector>

#include "plugin/paraview/client/views/clinical_views.h"

namespace palpate::plugin {

class ReferenceLines {
 public:
  ReferenceLines();
  ~ReferenceLines();
  ReferenceLines(const ReferenceLines&) = delete;
  ReferenceLines& operator=(const ReferenceLines&) = delete;

  /// The views of a scan that has just been shown; empty: none.
  void set_views(const std::vector<ClinicalView>& views);
  void set_visible(bool visible);
  /// After any of them shows another slice.
  void refresh();

 private:
  struct One;
  std::vector<std::unique_ptr<One>> views_;
  bool visible_ = false;
};

}  // namespace palpate::plugin
