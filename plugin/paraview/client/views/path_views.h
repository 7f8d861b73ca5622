#pragma once

/// A path through the patient, in all views of the scan.

#include <QColor>
#include <QPointer>

#include <memory>
#include <vector>

#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/views/clinical_views.h"
#include "plugin/paraview/client/views/path_glyphs.h"

namespace palpate::plugin {

class PathViews {
 public:
  PathViews(OpenViews& views, QColor color)
      : color_(std::move(color)),
        following_(views.follow(Layer::paths, [this](const auto& open) { set_views(open); })) {}

  /// Empty: none. `passing`: another path follows at once, so the volume view, which is slow to draw, can wait.
  void show(const std::vector<glm::dvec3>& path, bool passing = false);

 private:
  struct One {
    ViewKind kind;
    QPointer<pqRenderView> view;
    std::unique_ptr<PathGlyphs> glyphs;
  };
  void set_views(const std::vector<ClinicalView>& views);

  QColor color_;
  std::vector<One> views_;
  OpenViews::Following following_;
};

}  // namespace palpate::plugin
