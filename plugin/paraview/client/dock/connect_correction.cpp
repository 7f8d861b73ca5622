#include <pqUndoStack.h>

#include <QFileDialog>

#include <exception>
#include <utility>
#include <variant>
#include <vector>

#include "plugin/app/archive_settings.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/panel/correct_box.h"
#include "plugin/paraview/client/panel/curves_section.h"
#include "plugin/paraview/client/panel/outline_out.h"
#include "plugin/paraview/client/panel/profile_section.h"
#include "plugin/paraview/client/panel/send_dialog.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/widgets/fold.h"
#include "plugin/paraview/client/words.h"

// A structure is corrected: strokes come from the views and the stylus, and the outline goes out.

namespace palpate::plugin {

void PanelParts::connect_correction() {
  QObject::connect(&correction, &CorrectionModel::changed, &dock, [this] {
    share_picks();
    curves->set_key_undoes(!correction.structure());
  });
  QObject::connect(&correction, &CorrectionModel::stroke_changed, &dock, [this] {
    SCOPED_UNDO_EXCLUDE();
    drawn_stroke.show(correction.stroke(), !correction.stroke().empty());
  });
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
  readers.views().set_pick(on_slices);
  views.set_pick(in_volume);
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
    correction.draw(path->points_mm);
  } else {
    correction.draw({std::get<FeltMark>(made).position_mm});
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
  if (!file.isEmpty()) structures->correct_box().out().save(*outline, file.toStdString(), kind == contours, true);
}

/// Shows what would be sent, and sends it where that is wanted.
void PanelParts::send_outline() {
  const auto outline = corrected_outline();
  if (!outline) return;
  if (!scans.shown()->of.details()) {
    structures->tell(words(say("outline-needs-the-images")), true);
    return;
  }
  std::vector<io::Archive> archives;
  try {
    archives = read_archives();
  } catch (const std::exception& error) {
    structures->tell(QString::fromUtf8(error.what()), true);
    return;
  }
  if (archives.empty()) {
    structures->tell(words(say("no-archive-here-yet")), true);
    scan_fold->set_open(true);
    scan->show_archive();
    return;
  }
  SendDialog dialog(
      outline->series,
      SendDialog::of_outline(QString::fromStdString(outline->structure.name), structures->change_in_words()),
      std::move(archives), &dock);
  if (dialog.exec() == QDialog::Accepted) structures->correct_box().out().send(*outline, dialog.archive());
}

}  // namespace palpate::plugin
