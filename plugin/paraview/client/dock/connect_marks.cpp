#include <pqPipelineSource.h>
#include <pqUndoStack.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <memory>
#include <string>
#include <vector>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/layout/clinical_toolbar.h"
#include "plugin/paraview/client/panel/marks_section.h"
#include "plugin/paraview/client/panel/marks_sender.h"
#include "plugin/paraview/client/widgets/fold.h"
#include "plugin/paraview/client/words.h"
#include "plugin/session/scan_hash.h"

// Connections of the marks, which belong to the scan that is shown.

namespace palpate::plugin {

void PanelParts::connect_marks() {
  QObject::connect(&session, &SessionController::marked, &dock,
                   [this](const MarkMade& made) { correction.structure() ? draw_felt(made) : marks.add(made); });
  QObject::connect(&marks, &MarksModel::changed, &dock, [this] { layers.marks.refresh(); });
  QObject::connect(&marks, &MarksModel::added, &dock, [this] { column->marks_fold->set_open(true); });
  QObject::connect(column->marks, &MarksSection::listed, &dock, [this] {
    const QString words = column->marks->in_words();
    column->marks_fold->set_note(words);
    toolbar->show_marks(words);
  });
  QObject::connect(column->marks, &MarksSection::send_wanted, &dock, [this] { send_marks(); });
  QObject::connect(toolbar, &ClinicalToolbar::marks_wanted, &dock, [this] { column->marks_fold->set_open(true); });
  QObject::connect(column->marks, &MarksSection::chosen, &dock,
                   [this](const std::vector<std::size_t>& chosen) { layers.marks.set_chosen(chosen); });
  QObject::connect(column->marks, &MarksSection::place_wanted, &dock, [this](const glm::dvec3& place) {
    SCOPED_UNDO_EXCLUDE();
    readers.views().show_point(place);
  });
}

/// Shows what would be sent, and sends it if the user agrees.
void PanelParts::send_marks() {
  const io::Series* const series = scans.shown() ? scans.shown()->of.details() : nullptr;
  if (!series) {
    column->marks->tell(words(say("marks-need-the-images")), true);
    return;
  }
  // Copies: another scan may be opened while the dialog is.
  const io::Series of = *series;
  const std::shared_ptr<const io::Volume> volume = scans.shown()->volume;
  const Marks shown = marks.marks();
  const std::string scan_of_marks = marks.scan();
  const auto archive = choose_archive(of, SendDialog::of_marks(of, shown),
                                      [this](const QString& problem) { column->marks->tell(problem, true); });
  if (!archive) return;
  column->marks->sender().send(*archive, of, volume, shown,
                               [this, scan_of_marks, shown] { unsaved.note_marks_saved(scan_of_marks, shown); });
}

void PanelParts::show_marks(const ScanHandle& handle) {
  const char* const uid = vtkSMPropertyHelper(readers.source()->getProxy(), "SeriesUid").GetAsString();
  marks.set_scan(hash_of_series(uid ? uid : "", *handle.volume));
}

void PanelParts::leave_marks() {
  column->marks->sender().leave_scan();
  column->marks->tell({}, false);  // it was about the scan before
  marks.set_scan({});
}

}  // namespace palpate::plugin
