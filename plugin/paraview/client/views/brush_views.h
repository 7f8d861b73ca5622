#pragma once

/// The ball of add and remove, drawn in all views of the scan.

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/views/clinical_views.h"

namespace palpate::plugin {

struct Brush {
  glm::dvec3 center_mm{0};  ///< patient space
  double radius_mm = 0;
  bool operator==(const Brush&) const = default;
};

class BrushViews {
 public:
  explicit BrushViews(OpenViews& views);
  ~BrushViews();
  BrushViews(const BrushViews&) = delete;
  BrushViews& operator=(const BrushViews&) = delete;

  /// nullopt hides it. Slices show it as a circle where they cut it. The volume view, which is slow to draw, shows it
  /// in its next picture.
  void show(const std::optional<Brush>& brush);

 private:
  struct One;
  void set_views(const std::vector<ClinicalView>& views);

  std::optional<Brush> brush_;
  std::vector<std::unique_ptr<One>> views_;
  OpenViews::Following following_;
};

}  // namespace palpate::plugin
