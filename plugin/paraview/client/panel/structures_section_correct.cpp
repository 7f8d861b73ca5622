#include <QSignalBlocker>
#include <QToolButton>

#include <algorithm>
#include <utility>

#include "plugin/paraview/client/panel/correct_box.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/session/shared_distance.h"

// The structure that is being corrected.

namespace palpate::plugin {

bool StructuresSection::is_corrected(const Entry& entry) const {
  const io::Structure* const corrected = correction_.structure();
  return corrected && corrected->file == entry.structure.file && corrected->number == entry.structure.number;
}

const StructuresSection::Entry* StructuresSection::corrected_entry() const {
  const auto found = std::ranges::find_if(entries_, [this](const Entry& entry) { return is_corrected(entry); });
  return found == entries_.end() ? nullptr : &*found;
}

std::shared_ptr<const io::DistanceField> StructuresSection::corrected() const {
  const Entry* const entry = corrected_entry();
  const LoadedStructure* const now = entry ? felt(*entry) : nullptr;
  return now && now->edits == entry->edits ? now->distance : nullptr;
}

void StructuresSection::correct(bool on) {
  Entry* const entry = chosen();
  if (!on || !entry) return correction_.end();
  entry->shown = true;
  correction_.begin(entry->structure, entry->made.edges);
  list();
  draw();
  make_next();
}

void StructuresSection::follow_correction() {
  const QSignalBlocker quiet(correct_);
  correct_->setChecked(correction_.structure() != nullptr);
  correct_box_->set_change(change_in_words());
  draw();
}

QString StructuresSection::change_in_words() const {
  const Entry* const entry = corrected_entry();
  if (!entry || !entry->made.change || entry->made.edits != entry->edits) return {};
  constexpr double ml = 1000;
  const io::OutlineChange& change = *entry->made.change;
  const auto number = [](double of) { return QString::number(of, 'f', 2); };
  return tr("%1 ml, in the file %2 ml: %3 ml added, %4 ml removed. The edge moved %5 mm at most.")
      .arg(number(volume_of(*entry) / ml), number(entry->made.measures->volume_mm3 / ml), number(change.added_mm3 / ml),
           number(change.removed_mm3 / ml), number(change.largest_mm));
}

/// Of the outline as it is felt. Nobody waits for it.
void StructuresSection::find_doubtful(const io::Structure* structure, std::function<void(io::DoubtfulPlaces)> done) {
  doubting_.cancel();
  correct_box_->set_looking(-1);
  if (!structure || !scan_) return;
  std::shared_ptr<const io::DistanceField> outline = corrected();
  if (outline && outline->reach_mm() < io::doubt_within_mm) outline = nullptr;
  correct_box_->set_looking(0);
  doubting_.ask(
      [this, structure = *structure, outline, scan = scan_](const auto& job) {
        const auto of = outline ? outline : shared_distance(structure, scan->geometry, io::doubt_within_mm);
        const auto fields = io::edge_fields(scan);
        return io::doubtful_places({*fields, scan->geometry}, *of, [&](double part) {
          job.tell([this, part] { correct_box_->set_looking(part); });
          return job.keep_going();
        });
      },
      [this, done = std::move(done)](const auto& found, const QString& error) {
        correct_box_->set_looking(-1);
        if (found) done(*found);
        if (!error.isEmpty()) tell(error, true);
      });
}

}  // namespace palpate::plugin
