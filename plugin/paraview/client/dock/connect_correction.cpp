#include <pqActiveObjects.h>
#include <pqRenderView.h>
#include <pqUndoStack.h>

#include <QFileDialog>

#include <utility>
#include <variant>
#include <vector>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/panel/correct_box.h"
#include "plugin/paraview/client/panel/curves_section.h"
#include "plugin/paraview/client/panel/footer.h"
#include "plugin/paraview/client/panel/outline_out.h"
#include "plugin/paraview/client/panel/profile_section.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/paraview/client/words.h"

// A structure is corrected: strokes come from the views and the stylus, and the outline goes out.

namespace palpate::plugin {

void PanelParts::connect_correction() {
  correction.set_outline([this](const io::Vec3& place) -> std::optional<double> {
    const auto outline = structures->corrected();
    return outline ? std::optional(outline->sample(place).mm) : std::nullopt;
  });
  QObject::connect(&correction, &CorrectionModel::changed, &dock, [this] {
    share_picks();
    curves->set_key_undoes(!correction.structure());
    footer->set_corrects(correction.structure() != nullptr);
  });
  QObject::connect(&correction, &CorrectionModel::stroke_changed, &dock, [this] {
    SCOPED_UNDO_EXCLUDE();
    const bool on_slice = correction.stroke_over() == CorrectionModel::Over::slice;
    drawn_stroke.show(correction.stroke(), on_slice && !correction.stroke().empty());
  });
  QObject::connect(&structures->correct_box(), &CorrectBox::slice_wanted, &dock,
                   [this](bool held) { correction.hold_in(held ? marked_slice() : std::nullopt); });
  QObject::connect(&correction, &CorrectionModel::place_wanted, &dock, [this](const io::DoubtfulPlace& place) {
    SCOPED_UNDO_EXCLUDE();
    readers.views().show_point(place.position_mm);
    // A hand that holds nothing yet goes along, and stays outside.
    constexpr double before_mm = 5;
    if (touching.has_simulated() && !touching.last().feels) {
      touching.move_hand(place.position_mm + before_mm * place.normal);
    }
  });
  QObject::connect(&structures->correct_box(), &CorrectBox::save_wanted, &dock, [this] { save_outline(); });
  QObject::connect(&structures->correct_box(), &CorrectBox::send_wanted, &dock, [this] { send_outline(); });
  QObject::connect(&structures->correct_box().out(), &OutlineOut::told, structures, &StructuresSection::tell);
}

/// The left button beside the stylus: for the force profile's points, else for strokes on the slices.
void PanelParts::share_picks() {
  std::function<void(Pick, const glm::dvec3&)> on_slices, in_volume;
  if (profile_picks) {
    on_slices = in_volume = [this](Pick what, const glm::dvec3& place) { profile->pick(what, place); };
  } else if (correction.structure()) {
    on_slices = [this](Pick what, const glm::dvec3& place) {
      if (what == Pick::pressed) correction.press(place);
      if (what == Pick::moved) correction.move(place);
      if (what == Pick::let_go) correction.let_go();
    };
  }
  views.set_rays(
      correction.structure() && !profile_picks
          ? [this](Pick what, const auto& near, const auto& far) { return stroke_over_outline(what, near, far); }
          : StylusViews::Rays());
  readers.views().set_pick(on_slices);
  views.set_pick(in_volume);
}

/// In the volume view, where the pointer is over the outline, and that is seen; beside it the view is turned.
bool PanelParts::stroke_over_outline(Pick what, const glm::dvec3& near, const glm::dvec3& far) {
  const auto outline = structures->corrected();
  const auto place = outline ? first_on_outline(*outline, near, far) : std::nullopt;
  if (what == Pick::pressed && (!place || !structures->shows_corrected())) return false;
  if (what == Pick::pressed) correction.press(*place, CorrectionModel::Over::outline);
  if (what == Pick::moved && place) correction.move(*place);
  if (what == Pick::let_go) correction.let_go();
  return true;
}

/// The slice in the view that is marked, or else the axial one.
std::optional<HeldPlane> PanelParts::marked_slice() const {
  std::optional<HeldPlane> axial;
  for (const ClinicalView& one : open_views.now()) {
    if (!one.slice) continue;
    const HeldPlane plane{.point_mm = one.slice->place_at({0, 0}), .normal = one.slice->sight().along};
    if (one.view == pqActiveObjects::instance().activeView()) return plane;
    if (one.kind == ViewKind::axial) axial = plane;
  }
  return axial;
}

/// Another slice is shown in the view of the one that the hand is held in: the hand is held in that.
void PanelParts::follow_held_slice(const SliceView& shown) {
  const auto held = correction.held_in();
  if (!held || shown.sight().along != held->normal) return;
  correction.follow_slice({.point_mm = shown.place_at({0, 0}), .normal = held->normal});
}

/// Of what adds or removes, at the place under the pointer.
void PanelParts::show_brush(const std::optional<glm::dvec3>& at) {
  SCOPED_UNDO_EXCLUDE();
  const bool is_seen = at && correction.structure() && correction.tool() != CorrectionModel::Tool::trace;
  brush.show(is_seen ? std::optional(Brush{*at, correction.radius_mm()}) : std::nullopt);
}

/// What the stylus drew while its button was held.
void PanelParts::draw_felt(const MarkMade& made) {
  if (const auto* const path = std::get_if<MarkedPath>(&made)) {
    correction.draw_felt(path->points_mm);
  } else {
    correction.draw_felt({std::get<FeltMark>(made).position_mm});
  }
}

std::optional<CorrectedOutline> PanelParts::corrected_outline() {
  const auto distance = structures->corrected();
  if (!correction.structure() || !scans.shown() || !distance) return std::nullopt;
  const ScanHandle& handle = *scans.shown();
  const io::Series* const series = handle.of.details();
  return CorrectedOutline{.structure = *correction.structure(),
                          .distance = distance,
                          .series = series ? *series : io::Series(),
                          .frame = handle.frame,
                          .scan = handle.volume};
}

void PanelParts::save_outline() {
  const auto outline = corrected_outline();
  if (!outline) return;
  const auto edits = correction.edits();  // that the outline has
  const bool has_images = scans.shown()->of.details() != nullptr;
  const QString contours = tr("DICOM contours, RTSTRUCT (*.dcm)");
  QStringList kinds{tr("NIfTI (*.nii.gz *.nii)"), tr("NRRD (*.seg.nrrd *.nrrd)"), tr("MetaImage (*.mha)")};
  if (has_images) kinds = QStringList{tr("DICOM segmentation, SEG (*.dcm)"), contours} + kinds;
  QString kind;
  const QString file = QFileDialog::getSaveFileName(
      &dock, tr("Save the corrected outline"),
      QString::fromStdString(outline->structure.name) +
          (has_images ? QStringLiteral("-corrected.dcm") : QStringLiteral("-corrected.nii.gz")),
      kinds.join(QStringLiteral(";;")), &kind);
  // The dialog has asked whether an existing file may be overwritten.
  if (file.isEmpty()) return;
  structures->correct_box().out().save(
      *outline, file.toStdString(), kind == contours, true,
      [this, structure = outline->structure, edits] { unsaved.note_outline_saved(structure, edits); });
}

/// Shows what would be sent, and sends it where that is wanted.
void PanelParts::send_outline() {
  const auto outline = corrected_outline();
  if (!outline) return;
  if (!scans.shown()->of.details()) {
    structures->tell(words(say("outline-needs-the-images")), true);
    return;
  }
  const auto edits = correction.edits();  // that the outline has
  const SendDialog::Content content =
      SendDialog::of_outline(QString::fromStdString(outline->structure.name), structures->change_in_words());
  const auto archive =
      choose_archive(outline->series, content, [this](const QString& problem) { structures->tell(problem, true); });
  if (!archive) return;
  structures->correct_box().out().send(*outline, *archive, [this, structure = outline->structure, edits] {
    unsaved.note_outline_saved(structure, edits);
  });
}

}  // namespace palpate::plugin
