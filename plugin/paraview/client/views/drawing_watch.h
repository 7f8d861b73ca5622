#pragma once

/// Measures how long the views' pictures take: the UI thread is busy meanwhile.

#include <functional>
#include <memory>
#include <vector>

#include "plugin/paraview/client/model/open_views.h"

namespace palpate::plugin {

class DrawingWatch {
 public:
  /// `drawn` is called after each picture, with its duration.
  DrawingWatch(OpenViews& views, std::function<void(double seconds)> drawn);
  ~DrawingWatch();
  DrawingWatch(const DrawingWatch&) = delete;
  DrawingWatch& operator=(const DrawingWatch&) = delete;

 private:
  struct One;
  void set_views(const std::vector<ClinicalView>& views);

  std::function<void(double)> drawn_;
  std::vector<std::unique_ptr<One>> views_;
  OpenViews::Following following_;
};

}  // namespace palpate::plugin
