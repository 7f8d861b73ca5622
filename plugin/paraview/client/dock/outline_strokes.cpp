#include "plugin/paraview/client/dock/outline_strokes.h"

#include <pqActiveObjects.h>
#include <pqRenderView.h>
#include <pqUndoStack.h>

#include <functional>

#include "plugin/paraview/client/panel/profile_section.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/structures/edges_beside.h"

namespace palpate::plugin {

OutlineStrokes::OutlineStrokes(OpenViews& open, ClinicalViews& slices, StylusViews& volume, CorrectionModel& correction,
                               const StructuresSection& structures, ProfileSection& profile)
    : open_(open),
      slices_(slices),
      volume_(volume),
      correction_(correction),
      structures_(structures),
      profile_(profile),
      drawn_(open, QColor(255, 240, 80)),
      brush_(open) {
  QObject::connect(&correction, &CorrectionModel::changed, &profile, [this] { share_button(); });
  QObject::connect(&correction, &CorrectionModel::stroke_changed, &profile, [this] { draw_stroke(); });
}

void OutlineStrokes::give_to_profile(bool on) {
  profile_picks_ = on;
  share_button();
}

/// On the slices each stroke is the correction's; in the volume view only where the pointer is over the outline.
void OutlineStrokes::share_button() {
  std::function<void(Pick, const glm::dvec3&)> on_slices, in_volume;
  StylusViews::Rays over_outline;
  if (profile_picks_) {
    on_slices = in_volume = [this](Pick what, const glm::dvec3& place) { profile_.pick(what, place); };
  } else if (correction_.structure()) {
    on_slices = [this](Pick what, const glm::dvec3& place) {
      if (what == Pick::pressed) correction_.press(place);
      if (what == Pick::moved) correction_.move(place);
      if (what == Pick::let_go) correction_.let_go();
    };
    over_outline = [this](Pick what, const auto& near, const auto& far) { return press_outline(what, near, far); };
  }
  volume_.set_rays(over_outline);
  slices_.set_pick(on_slices);
  volume_.set_pick(in_volume);
}

/// Where the pointer is over the outline, and that is seen; beside it the view is turned.
bool OutlineStrokes::press_outline(Pick what, const glm::dvec3& near, const glm::dvec3& far) {
  const auto outline = structures_.corrected();
  const auto place = outline ? first_on_outline(*outline, near, far) : std::nullopt;
  if (what == Pick::pressed && (!place || !structures_.shows_corrected())) return false;
  if (what == Pick::pressed) correction_.press(*place, CorrectionModel::Over::outline);
  if (what == Pick::moved && place) correction_.move(*place);
  if (what == Pick::let_go) correction_.let_go();
  return true;
}

void OutlineStrokes::draw_stroke() {
  SCOPED_UNDO_EXCLUDE();
  const bool on_slice = correction_.stroke_over() == CorrectionModel::Over::slice;
  drawn_.show(correction_.stroke(), on_slice && !correction_.stroke().empty());
}

void OutlineStrokes::show_brush(const std::optional<glm::dvec3>& at) {
  SCOPED_UNDO_EXCLUDE();
  const bool is_seen = at && correction_.structure() && correction_.tool() != CorrectionModel::Tool::trace;
  brush_.show(is_seen ? std::optional(Brush{*at, correction_.radius_mm()}) : std::nullopt);
}

std::optional<HeldPlane> OutlineStrokes::marked_slice() const {
  std::optional<HeldPlane> axial;
  for (const ClinicalView& one : open_.now()) {
    if (!one.slice) continue;
    const HeldPlane plane{.point_mm = one.slice->place_at({0, 0}), .normal = one.slice->sight().along};
    if (one.view == pqActiveObjects::instance().activeView()) return plane;
    if (one.kind == ViewKind::axial) axial = plane;
  }
  return axial;
}

void OutlineStrokes::follow_slice(const SliceView& shown) {
  const auto held = correction_.held_in();
  if (!held || shown.sight().along != held->normal) return;
  correction_.follow_slice({.point_mm = shown.place_at({0, 0}), .normal = held->normal});
}

}  // namespace palpate::plugin
