#pragma once

/// Handles the left mouse button in the views while an outline is corrected, and draws its strokes. The force profile's
/// picking takes precedence.

#include <glm/vec3.hpp>
#include <optional>

#include "plugin/paraview/client/model/correction_model.h"
#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/stylus/stylus_views.h"
#include "plugin/paraview/client/views/brush_views.h"
#include "plugin/paraview/client/views/clinical_views.h"
#include "plugin/paraview/client/views/path_views.h"

namespace palpate::plugin {

class ProfileSection;
class StructuresSection;

class OutlineStrokes {
 public:
  OutlineStrokes(OpenViews& open, ClinicalViews& slices, StylusViews& volume, CorrectionModel& correction,
                 const StructuresSection& structures, ProfileSection& profile);
  OutlineStrokes(const OutlineStrokes&) = delete;
  OutlineStrokes& operator=(const OutlineStrokes&) = delete;

  /// Whether the button picks points of the force profile.
  void give_to_profile(bool on);
  /// Draws the brush of add or remove at the place under the pointer.
  void show_brush(const std::optional<glm::dvec3>& at);
  /// A view shows another slice: if the hand is held in that view's slice, it is moved to the new one.
  void follow_slice(const SliceView& shown);
  /// The slice of the active view; if that is no slice view, the axial one.
  std::optional<HeldPlane> marked_slice() const;

 private:
  void share_button();
  void draw_stroke();
  bool press_outline(Pick what, const glm::dvec3& near, const glm::dvec3& far);

  OpenViews& open_;
  ClinicalViews& slices_;
  StylusViews& volume_;
  CorrectionModel& correction_;
  const StructuresSection& structures_;
  ProfileSection& profile_;
  bool profile_picks_ = false;
  PathViews drawn_;
  BrushViews brush_;
};

}  // namespace palpate::plugin
