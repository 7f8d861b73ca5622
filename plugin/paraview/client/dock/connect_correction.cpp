#include <pqUndoStack.h>

#include <QFileDialog>
#include <QStringList>

#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "io/interchange/voxel_file.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/panel/correct_box.h"
#include "plugin/paraview/client/panel/curves_section.h"
#include "plugin/paraview/client/panel/footer.h"
#include "plugin/paraview/client/panel/outline_out.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/paraview/client/words.h"

// Connections for correcting a structure: strokes come from the views and the stylus, and the outline is saved or sent.

namespace palpate::plugin {
namespace {

/// As a file dialog has them: "NIfTI (*.nii.gz *.nii)", ...
QStringList label_map_kinds() {
  const auto text = [](std::string_view utf8) { return QString::fromUtf8(utf8.data(), static_cast<int>(utf8.size())); };
  QStringList kinds;
  for (const io::LabelFormat* const format : io::label_formats()) {
    QStringList endings;
    for (const std::string_view ending : format->written) {
      if (!ending.empty()) endings << QLatin1Char('*') + text(ending);
    }
    if (!endings.isEmpty()) kinds << QStringLiteral("%1 (%2)").arg(text(format->name), endings.join(QLatin1Char(' ')));
  }
  return kinds;
}

}  // namespace

void PanelParts::connect_correction() {
  correction.set_outline([this](const io::Vec3& place) -> std::optional<double> {
    const auto outline = column->structures->corrected();
    return outline ? std::optional(outline->sample(place).mm) : std::nullopt;
  });
  QObject::connect(&correction, &CorrectionModel::changed, &dock, [this] {
    column->curves->set_key_shows_before(!correction.structure());
    column->footer->set_corrects(correction.structure() != nullptr);
  });
  QObject::connect(&column->structures->correct_box(), &CorrectBox::slice_wanted, &dock,
                   [this](bool held) { correction.hold_in(held ? strokes->marked_slice() : std::nullopt); });
  QObject::connect(&correction, &CorrectionModel::place_wanted, &dock, [this](const io::DoubtfulPlace& place) {
    SCOPED_UNDO_EXCLUDE();
    readers.views().show_point(place.position_mm);
    // A hand that holds nothing yet goes along, and stays outside.
    constexpr double before_mm = 5;
    if (session.has_simulated() && !session.last().feels) {
      session.move_hand(place.position_mm + before_mm * place.normal);
    }
  });
  QObject::connect(&column->structures->correct_box(), &CorrectBox::save_wanted, &dock, [this] { save_outline(); });
  QObject::connect(&column->structures->correct_box(), &CorrectBox::send_wanted, &dock, [this] { send_outline(); });
  QObject::connect(&column->structures->correct_box().out(), &OutlineOut::told, column->structures,
                   &StructuresSection::tell);
}

/// Takes the stroke that the stylus drew while its button was held.
void PanelParts::draw_felt(const MarkMade& made) {
  if (const auto* const path = std::get_if<MarkedPath>(&made)) {
    correction.draw_felt(path->points_mm);
  } else {
    correction.draw_felt({std::get<FeltMark>(made).position_mm});
  }
}

std::optional<CorrectedOutline> PanelParts::corrected_outline() {
  const auto distance = column->structures->corrected();
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
  QStringList kinds = label_map_kinds();
  if (has_images) kinds = QStringList{tr("DICOM segmentation, SEG (*.dcm)"), contours} + kinds;
  QString kind;
  const QString file = QFileDialog::getSaveFileName(
      &dock, tr("Save the corrected outline"),
      QString::fromStdString(outline->structure.name) + QStringLiteral("-corrected") +
          (has_images ? QStringLiteral(".dcm") : QString::fromStdString(io::written_endings().front())),
      kinds.join(QStringLiteral(";;")), &kind);
  // The dialog has asked whether an existing file may be overwritten.
  if (file.isEmpty()) return;
  column->structures->correct_box().out().save(
      *outline, file.toStdString(), kind == contours, true,
      [this, structure = outline->structure, edits] { unsaved.note_outline_saved(structure, edits); });
}

/// Shows what would be sent, and sends it if the user agrees.
void PanelParts::send_outline() {
  const auto outline = corrected_outline();
  if (!outline) return;
  if (!scans.shown()->of.details()) {
    column->structures->tell(words(say("outline-needs-the-images")), true);
    return;
  }
  const auto edits = correction.edits();  // that the outline has
  const SendDialog::Content content =
      SendDialog::of_outline(QString::fromStdString(outline->structure.name), column->structures->change_in_words());
  const auto archive = choose_archive(outline->series, content,
                                      [this](const QString& problem) { column->structures->tell(problem, true); });
  if (!archive) return;
  column->structures->correct_box().out().send(*outline, *archive, [this, structure = outline->structure, edits] {
    unsaved.note_outline_saved(structure, edits);
  });
}

}  // namespace palpate::plugin
