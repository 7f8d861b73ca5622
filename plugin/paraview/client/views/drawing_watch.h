#pragma once

/// How long the views' pictures take: the thread that draws them does nothing else meanwhile.

#include <functional>
#include <memory>
#include <vector>

#include "plugin/paraview/client/model/open_views.h"

namespace palpate::plugin {

class DrawingWatch {
 public:
  /// `drawn` is told of each picture, seconds.
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
