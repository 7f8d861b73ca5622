#pragma once

/// The boundaries that are felt, as lines in their own colors on the slices that are shown.

#include <memory>
#include <vector>

#include "io/fields/volume_fields.h"
#include "io/volume.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene.h"
#include "plugin/paraview/client/views/clinical_views.h"

namespace palpate::plugin {

class BoundaryContours {
 public:
  BoundaryContours();
  ~BoundaryContours();
  BoundaryContours(const BoundaryContours&) = delete;
  BoundaryContours& operator=(const BoundaryContours&) = delete;

  /// The views of a scan that has just been shown; empty: none.
  void set_views(const std::vector<ClinicalView>& views);
  /// What is drawn: what that plan of the scene makes of the volume. Made in the background; the lines that are there
  /// stay meanwhile. Without a volume or a plan nothing is drawn.
  void set_felt(const std::shared_ptr<const io::Volume>& volume, const modes::Scene& scene,
                const std::shared_ptr<const modes::Plan>& plan);
  void set_visible(bool visible);
  /// Draws the lines of the slice that a view shows now.
  void show(SliceView& slice);

 private:
  struct One;
  struct Felt;
  void draw(One& one);

  std::vector<std::unique_ptr<One>> views_;
  std::shared_ptr<const Felt> felt_;
  bool visible_ = true;
};

}  // namespace palpate::plugin
