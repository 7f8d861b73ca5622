#pragma once

/// The left button in the views while an outline is corrected, and what is drawn of its strokes. The force profile has
/// the button first.

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

  /// Whether the force profile's points are picked.
  void give_to_profile(bool on);
  /// Of what adds or removes, at the place under the pointer.
  void show_brush(const std::optional<glm::dvec3>& at);
  /// Another slice is shown in a view: if it is that of the one that the hand is held in, the hand is held in it.
  void follow_slice(const SliceView& shown);
  /// The slice in the view that is marked, or else the axial one.
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
