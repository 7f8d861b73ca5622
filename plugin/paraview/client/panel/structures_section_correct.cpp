#include <QSignalBlocker>
#include <QSlider>
#include <QToolButton>

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

#include "plugin/paraview/client/panel/correct_box.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/structures/drawn_structure.h"
#include "plugin/structures/shared_distance.h"

// The correction of a structure.

namespace palpate::plugin {

bool StructuresSection::is_corrected(const Entry& entry) const {
  const io::Structure* const corrected = correction_.structure();
  return corrected && is_same(*corrected, entry.structure);
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

bool StructuresSection::shows_corrected() const {
  const Entry* const entry = corrected_entry();
  return entry && entry->shown && opacity_->value() > 0;
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
  measure_margins();
  correct_box_->set_change(correction_.shows_before() ? tr("The outline is shown as it is in the file.")
                                                      : change_in_words());
  correction_.outline_changed();
  follow_strokes();
  draw();
}

/// Saving and sending wait for strokes that are not yet part of the outline.
void StructuresSection::follow_strokes() {
  correct_box_->set_whole(corrected() != nullptr && !model_.is_waiting());
}

QString StructuresSection::change_in_words() const {
  const Entry* const entry = corrected_entry();
  if (!entry || !entry->made.change || entry->made.edits != entry->edits) return {};
  constexpr double ml = 1000;
  const io::OutlineChange& change = *entry->made.change;
  const auto number = [](double of) { return QString::number(of, 'f', 2); };
  const QString text =
      contours_of(entry->structure)
          ? tr("Volume %1 ml (first drawn: %2 ml). %3 ml were added, %4 ml removed. The edge moved %5 mm at most.")
          : tr("Volume %1 ml (in the file: %2 ml). %3 ml were added, %4 ml removed. The edge moved %5 mm at most.");
  return text.arg(number(volume_of(*entry) / ml), number(entry->made.measures->volume_mm3 / ml),
                  number(change.added_mm3 / ml), number(change.removed_mm3 / ml), number(change.largest_mm)) +
         margins_in_words();
}

/// Measures from the edited outline to the scene's keep-outs, if one of them has changed.
void StructuresSection::measure_margins() {
  const Entry* const entry = corrected_entry();
  const auto outline = corrected();
  if (!entry || !outline || !is_edited(*entry) || entry->made.edits != entry->edits) return;
  std::vector<KeepOut> keep_outs;
  for (const Entry& other : entries_) {
    const LoadedStructure* const read = felt(other);
    const std::optional<double> margin_mm = keep_out_of(model_.scene(), other.structure);
    if (&other == entry || !read || !margin_mm || !other.made.measures) continue;
    io::StructureBox box{other.made.measures->box_low_mm, other.made.measures->box_high_mm};
    if (const auto edited = io::box_of_edits(read->edits)) {
      box = {glm::min(box.low_mm, edited->low_mm), glm::max(box.high_mm, edited->high_mm)};
    }
    keep_outs.push_back({other.structure.name, *margin_mm, read->distance, box});
  }
  margins_.measure(outline, {entry->made.drawn.low_mm, entry->made.drawn.high_mm}, keep_outs);
}

QString StructuresSection::margins_in_words() const {
  QString text;
  for (const OutlineMargin& one : margins_.of(corrected())) {
    const QString name = QString::fromStdString(one.name);
    const auto mm = [](double length) { return QString::number(length, 'f', 1); };
    text += QLatin1Char('\n') + (one.mm < 0 ? tr("The structure reaches %1 mm into %2.").arg(mm(-one.mm), name)
                                            : tr("Distance to %1: %2 mm. The keep-out margin of %1 is %3 mm wide.")
                                                  .arg(name, mm(one.mm), mm(one.keep_out_mm)));
  }
  return text;
}

/// The outline as it is felt, or the file's, with at least that reach.
std::function<std::shared_ptr<const io::DistanceField>()> StructuresSection::outline_within(
    const io::Structure& structure, double reach_mm) const {
  std::shared_ptr<const io::DistanceField> outline = corrected();
  if (outline && outline->reach_mm() < reach_mm) outline = nullptr;
  return [structure, outline, reach_mm, scan = scan_] {
    return outline ? outline : shared_distance(structure, scan->geometry, reach_mm);
  };
}

/// Of the outline as it is felt: the edge lies beside that.
void StructuresSection::look_beside(std::vector<io::Vec3> places, double within_mm,
                                    std::function<void(const CorrectionModel::Edges&)> done) {
  looking_beside_.cancel();
  if (places.empty() || !scan_ || !correction_.structure()) return;
  looking_beside_.ask(
      [places = std::move(places), within_mm, scan = scan_,
       outline = outline_within(*correction_.structure(), within_mm)](const auto& job) {
        return edges_beside(places, *outline(), scan, within_mm, [&](double) { return job.keep_going(); });
      },
      [this, done = std::move(done)](const auto& found, const QString& error) {
        if (!error.isEmpty()) tell(error, true);
        done(found ? *found : CorrectionModel::Edges());
      });
}

/// Of the outline as it is felt. Nobody waits for it.
void StructuresSection::find_doubtful(const io::Structure* structure, std::function<void(io::DoubtfulPlaces)> done) {
  doubting_.cancel();
  correct_box_->set_looking(-1);
  if (!structure || !scan_) return;
  correct_box_->set_looking(0);
  doubting_.ask(
      [this, outline = outline_within(*structure, io::doubt_within_mm), scan = scan_](const auto& job) {
        const auto of = outline();
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
