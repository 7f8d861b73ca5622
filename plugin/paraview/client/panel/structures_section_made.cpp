#include <QLabel>
#include <QSlider>

#include <algorithm>
#include <glm/common.hpp>
#include <string>
#include <utility>

#include "io/fields/filtered.h"
#include "io/structures/outline_change.h"
#include "modes/types/mode_type.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/paraview/client/words.h"
#include "plugin/structures/drawn_structure.h"
#include "plugin/structures/study_structures.h"

// The background results for structures, measures and shapes, and their drawing in the views.

namespace palpate::plugin {
namespace {

/// The outline before its edits: of its file, or of the contours that define it.
std::shared_ptr<const io::DistanceField> before_edits_of(const LoadedStructure& structure) {
  const std::size_t making = structure.file.empty() ? 1 : 0;
  return structure.before_edits.size() > making ? structure.before_edits[making] : structure.distance;
}

}  // namespace

/// The file's, and what edits have added and removed.
double StructuresSection::volume_of(const Entry& entry) {
  const double before = entry.made.measures->volume_mm3;
  return entry.made.change ? before + entry.made.change->added_mm3 - entry.made.change->removed_mm3 : before;
}

bool StructuresSection::is_edited(const Entry& entry) {
  return entry.edits.size() > making_edits(entry.structure);
}

/// The felt structure; null if it is not felt.
const LoadedStructure* StructuresSection::felt(const Entry& entry) const {
  const PreparedScene& prepared = session_.live().felt();
  if (!scan_ || !prepared.volume || io::raw_of(prepared.volume) != io::raw_of(scan_)) return nullptr;
  const auto& structures = prepared.structures;
  const io::ContoursEdit* const contours = contours_of(entry.structure);
  const auto found = std::ranges::find_if(structures, [&](const LoadedStructure& one) {
    if (contours) return one.file.empty() && one.edits.front() == io::Edit(*contours);
    return one.file == entry.structure.file.string() &&
           (one.segment == "#" + std::to_string(entry.structure.number) || one.segment == entry.structure.name);
  });
  return found == structures.end() ? nullptr : &*found;
}

/// Measures and shapes, one after the other: first of visible structures.
void StructuresSection::make_next() {
  if (making_.is_busy() || !scan_) return;
  const auto wants = [this](bool drawn) {
    return [this, drawn](const Entry& entry) {
      if (!entry.why_not.empty()) return false;
      if (!drawn) return !entry.made.measures;
      // Reports on a correction refer to the felt field.
      const LoadedStructure* const now = is_corrected(entry) ? felt(entry) : nullptr;
      if (now && now->edits == entry.edits && before_edits_of(*now) != entry.made.outline) return true;
      return entry.shown &&
             (!entry.made.drawn.distance || entry.made.edits != entry.edits || entry.made.scan.lock() != scan_);
    };
  };
  auto next = std::ranges::find_if(entries_, wants(true));
  if (next == entries_.end()) next = std::ranges::find_if(entries_, wants(false));
  if (next == entries_.end()) return;
  WantedStructure wanted{.structure = next->structure,
                         .edits = next->edits,
                         .measures = next->made.measures,
                         .outline = nullptr,
                         .surface_before = next->made.edits.size() > making_edits(next->structure)
                                               ? next->made.drawn.surface_before
                                               : next->made.drawn.surface,
                         .draws = next->shown,
                         .scan = scan_};
  if (const LoadedStructure* const now = felt(*next)) {
    wanted.outline = before_edits_of(*now);
  }
  making_.ask([wanted] { return make_structure(wanted); },
              [this](const auto& made, const QString&) {
                if (made) take_made(*made);
                make_next();
              });
}

void StructuresSection::take_made(const MadeStructure& made) {
  const auto entry =
      std::ranges::find_if(entries_, [&](const Entry& one) { return is_same(one.structure, made.structure); });
  if (entry == entries_.end()) return;  // another scan is shown meanwhile
  entry->why_not = made.error;
  if (!made.error.empty()) entry->shown = false;
  if (made.drawn.distance) {
    entry->made = made;
  } else {
    entry->made.measures = made.measures;
  }
  look_whether_off(*entry);
  if (is_corrected(*entry)) correction_.set_edges(entry->made.edges);
  list();
  follow_correction();
}

/// Of several such structures the first is reported; each is marked in its row.
void StructuresSection::look_whether_off(Entry& entry) {
  if (!entry.made.measures || !entry.off.empty()) return;
  const bool first = std::ranges::all_of(entries_, [](const Entry& one) { return one.off.empty(); });
  entry.off =
      off_scan(entry.structure, {entry.made.measures->box_low_mm, entry.made.measures->box_high_mm}, scan_->geometry);
  if (entry.off.empty() || !first) return;
  const QString before = message_->text();
  tell(before.isEmpty() ? words(entry.off) : before + QLatin1Char('\n') + words(entry.off), true);
}

/// The distances at which the margins of a structure in the scene begin.
std::vector<double> StructuresSection::margins_of(const io::Structure& structure) const {
  const modes::Scene& scene = model_.scene();
  std::vector<double> margins;
  for (const modes::SceneStructure& named : scene.structures) {
    if (!is_same(named, structure)) continue;
    for (const modes::Mode& mode : scene.modes) {
      if (!mode.enabled || mode.structure != named.name || !modes::reads_key(mode, modes::Key::margin)) continue;
      margins.push_back(-modes::find_mode_type(mode.type)->margin_side * mode.margin_mm);
    }
  }
  return margins;
}

void StructuresSection::draw() {
  std::vector<DrawnStructure> shown;
  for (const Entry& entry : entries_) {
    if (!entry.shown || !entry.made.drawn.distance) continue;
    DrawnStructure& drawn = shown.emplace_back(entry.made.drawn);
    drawn.color = QColor(QString::fromStdString(entry.color));
    drawn.margins_mm = margins_of(entry.structure);
    const LoadedStructure* const now = felt(entry);
    const bool waits = now && !drawn.before && is_edited(entry);  // the first edit is felt, and not made yet
    const auto before = waits ? before_edits_of(*now) : drawn.before;
    if (correction_.shows_before() && is_corrected(entry) && before) {
      drawn.distance = before;
      drawn.before = nullptr;
      if (drawn.surface_before) drawn.surface = drawn.surface_before;
      continue;
    }
    if (!now || now->edits != entry.edits || now->edits == entry.made.edits) continue;
    if (entry.made.edits.size() <= making_edits(entry.structure)) drawn.surface_before = drawn.surface;
    // The lines on the slices are those of the felt field, even while the surface is still being computed.
    drawn.distance = now->distance;
    drawn.before = is_edited(entry) ? before_edits_of(*now) : nullptr;
    if (const auto box = io::box_of_edits(now->edits)) {
      drawn.low_mm = glm::min(drawn.low_mm, box->low_mm);
      drawn.high_mm = glm::max(drawn.high_mm, box->high_mm);
    }
  }
  drawn_.set_structures(std::move(shown), opacity_->value() / 100.0);
}

}  // namespace palpate::plugin
