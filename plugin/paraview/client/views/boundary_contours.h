#pragma once

/// The felt boundaries in their own colors: as lines on the slices, and optionally as surfaces in the volume view.

#include <memory>
#include <optional>
#include <vector>

#include "io/fields/volume_fields.h"
#include "io/volume.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene.h"
#include "plugin/app/live_session.h"
#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/views/clinical_views.h"

namespace palpate::plugin {

class FeltSurfaces;

class BoundaryContours {
 public:
  explicit BoundaryContours(OpenViews& views);
  ~BoundaryContours();
  BoundaryContours(const BoundaryContours&) = delete;
  BoundaryContours& operator=(const BoundaryContours&) = delete;

  /// Sets what is drawn: the boundaries of this plan of the scene in the volume. They are computed in the background.
  /// Meanwhile lines of the same slice and scan stay, others are hidden at once. Results of earlier scenes are kept, so
  /// that an undone step is shown at once. Lines of an earlier scene are shown only while a node is dragged. Without a
  /// volume or a plan nothing is drawn.
  void set_felt(const std::shared_ptr<const io::Volume>& volume, const modes::Scene& scene,
                const std::shared_ptr<const modes::Plan>& plan, Pace pace);
  void set_visible(bool visible);
  /// Shows surfaces instead of the scan in the volume view.
  void set_surfaces(bool visible);
  /// The felt fields at a place in the patient, mm: value and gradient. None outside the scan.
  std::optional<io::Sample> sample(const glm::dvec3& place) const;

 private:
  struct One;
  struct Felt;
  void set_views(const std::vector<ClinicalView>& views);
  /// Draws the lines of the slice that a view shows now.
  void show(SliceView& slice);
  void draw(One& one);

  std::vector<std::unique_ptr<One>> views_;
  std::unique_ptr<FeltSurfaces> surfaces_;
  std::shared_ptr<const Felt> felt_;
  bool visible_ = true;
  OpenViews::Following following_;
};

}  // namespace palpate::plugin
