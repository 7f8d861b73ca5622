#include "plugin/paraview/client/panel/structures_section.h"

#include <QDoubleSpinBox>
#include <QLabel>
#include <QPixmap>
#include <QPointer>
#include <QSignalBlocker>
#include <QSlider>
#include <QToolButton>
#include <QTreeWidget>

#include <algorithm>
#include <glm/common.hpp>
#include <string>
#include <utility>

#include "io/fields/filtered.h"
#include "io/structures/outline_change.h"
#include "modes/types/mode_type.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/words.h"
#include "plugin/structures/drawn_structure.h"
#include "plugin/structures/structure_files.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {
namespace {

constexpr std::size_t shown_at_once = 5;  // so many are shown without being asked for
// Told apart by the color-blind, too: after Okabe and Ito.
constexpr const char* structure_colors[] = {"#e69f00", "#56b4e9", "#009e73", "#f0e442",
                                            "#0072b2", "#d55e00", "#cc79a7"};

QString structure_text(const std::string& utf8) {
  return QString::fromStdString(utf8);
}

/// The outline that its edits change: its file's, or that of the contours that make it.
std::shared_ptr<const io::DistanceField> before_edits_of(const LoadedStructure& structure) {
  const std::size_t making = structure.file.empty() ? 1 : 0;
  return structure.before_edits.size() > making ? structure.before_edits[making] : structure.distance;
}

QString volume_in_words(double mm3) {
  constexpr double small_ml = 10, ml = 1000;
  return QStringLiteral("%1 ml").arg(mm3 / ml, 0, 'f', mm3 / ml < small_ml ? 2 : 0);
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

StructuresSection::StructuresSection(OpenViews& views, SceneModel& model, SessionController& session,
                                     CorrectionModel& correction, QWidget* parent)
    : QWidget(parent),
      model_(model),
      session_(session),
      correction_(correction),
      drawn_(views),
      finder_([this](const auto& found) { take(found); }, [this](const QString& why) { tell(why, true); }) {
  setObjectName(QStringLiteral("palpateStructures"));
  setAcceptDrops(true);
  build();
  connect(&model, &SceneModel::changed, this, [this](Pace pace) {
    if (pace == Pace::stepped) follow_scene();
  });
  correction.set_press([this](const QString& what, const SceneModel::Change& change) {
    tell({}, false);
    model_.edit(what, change, [alive = QPointer(this)](const QString& why) {
      if (!alive) return;
      alive->tell(why, !why.isEmpty());
      alive->follow_strokes();
    });
    follow_strokes();
  });
  correction.set_find([this](const io::Structure* structure, auto done) { find_doubtful(structure, std::move(done)); });
  correction.set_look_beside([this](std::vector<io::Vec3> places, double within_mm, auto done) {
    look_beside(std::move(places), within_mm, std::move(done));
  });
  connect(&correction, &CorrectionModel::nothing_traced, this,
          [this] { tell(words(say("scan-has-no-edge-there")), false); });
  connect(&correction, &CorrectionModel::changed, this, [this] { follow_correction(); });
  list();
}

StructuresSection::~StructuresSection() {
  correction_.set_press([](const QString&, const SceneModel::Change&) {});
  correction_.set_find({});
  correction_.set_look_beside({});
}

void StructuresSection::set_scan(std::shared_ptr<const io::Volume> scan, const std::string& folder) {
  correction_.forget();  // while the scan is here: the scene follows
  finder_.set_scan(scan);
  making_.cancel();
  margins_.forget();
  scan_ = std::move(scan);
  entries_.clear();
  tell({}, false);
  list();
  draw();
  if (!scan_) return;
  std::error_code absent;
  if (!folder.empty() && std::filesystem::exists(folder, absent)) finder_.look_into({folder});
  follow_scene();
}

void StructuresSection::set_frame(const std::shared_ptr<const io::Volume>& frame) {
  if (scan_ == frame) return;
  scan_ = frame;
  finder_.set_frame(frame);
  making_.cancel();
  follow_scene();
  correction_.look_again();
  follow_correction();
}

void StructuresSection::add(const std::vector<std::filesystem::path>& files, const QString& problem) {
  if (!problem.isEmpty()) tell(problem, true);
  finder_.look_into_served(files, problem);
}

void StructuresSection::take(const StructureFinder::Found& result) {
  const io::StructureCatalogue& found = result.catalogue;
  QStringList notes;
  if (!result.problem.isEmpty()) notes << result.problem;
  if (result.served) {
    for (const io::SkippedFile& one : found.skipped) notes << structure_text(one.reason);
  }
  const bool few = found.structures.size() + entries_.size() <= shown_at_once;
  for (const io::Structure& structure : found.structures) {
    const bool known =
        std::ranges::any_of(entries_, [&](const Entry& entry) { return is_same(entry.structure, structure); });
    if (known) continue;
    Entry entry{.structure = structure};
    entry.why_not = place_on(entry.structure, found.registrations, *scan_).why_not;
    for (std::size_t n = structure.warnings.size(); n < entry.structure.warnings.size(); ++n) {
      const QString note = structure_text(entry.structure.warnings[n]);
      if (!notes.contains(note)) notes << note;
    }
    entry.color =
        structure.color.empty() ? structure_colors[entries_.size() % std::size(structure_colors)] : structure.color;
    entry.structure.color = entry.color;
    entry.shown = entry.why_not.empty() && few;
    entries_.push_back(std::move(entry));
  }
  if (result.asked && found.structures.empty()) {
    tell(found.skipped.empty()
             ? tr("No structures were found there (DICOM SEG or RTSTRUCT).")
             : structure_text(found.skipped.front().path.filename().string() + ": " + found.skipped.front().reason),
         true);
  } else {
    tell(notes.join(QLatin1Char('\n')), !notes.isEmpty());
  }
  follow_scene();
}

/// Those that the scene's own contours make come and go with it.
void StructuresSection::follow_drawn() {
  const auto& structures = model_.scene().structures;
  std::erase_if(entries_, [&](const Entry& entry) {
    const io::ContoursEdit* const contours = contours_of(entry.structure);
    return contours && std::ranges::none_of(structures, [&](const modes::SceneStructure& named) {
             return is_same(named, entry.structure) && std::get<io::ContoursEdit>(named.edits.front()) == *contours;
           });
  });
  for (const modes::SceneStructure& named : structures) {
    const auto is_it = [&](const Entry& entry) { return is_same(named, entry.structure); };
    if (!scan_ || !modes::is_drawn(named) || std::ranges::any_of(entries_, is_it)) continue;
    Entry entry{.structure = drawn_structure(named)};
    entry.color = named.color.empty() ? structure_colors[entries_.size() % std::size(structure_colors)] : named.color;
    entry.structure.color = entry.color;
    entry.shown = entries_.size() < shown_at_once;
    entries_.push_back(std::move(entry));
  }
}

/// What the scene names is listed and shown, in the scene's color, wherever it came from.
void StructuresSection::follow_scene() {
  follow_drawn();
  std::vector<std::filesystem::path> files;
  for (const modes::SceneStructure& named : model_.scene().structures) {
    const auto entry = std::ranges::find_if(entries_, [&](const Entry& one) { return is_same(named, one.structure); });
    if (entry == entries_.end()) {
      if (!modes::is_drawn(named)) files.emplace_back(named.file);
      continue;
    }
    if (!named.color.empty()) entry->color = named.color;
  }
  for (Entry& entry : entries_) {
    const auto named = std::ranges::find_if(
        model_.scene().structures, [&](const modes::SceneStructure& one) { return is_same(one, entry.structure); });
    entry.edits = named == model_.scene().structures.end() ? std::vector<io::Edit>() : named->edits;
  }
  std::error_code absent;
  std::erase_if(files, [&](const auto& file) { return !std::filesystem::exists(copy_of(file), absent); });
  list();
  draw();
  make_next();
  measure_margins();
  follow_strokes();
  finder_.look_into(files);
}

StructuresSection::Entry* StructuresSection::chosen() {
  const int row = list_->indexOfTopLevelItem(list_->currentItem());
  return row < 0 || row >= static_cast<int>(entries_.size()) ? nullptr : &entries_[static_cast<std::size_t>(row)];
}

void StructuresSection::list() {
  if (std::exchange(listing_, true)) return;
  while (list_->topLevelItemCount() > static_cast<int>(entries_.size())) {
    delete list_->takeTopLevelItem(list_->topLevelItemCount() - 1);
  }
  for (std::size_t n = 0; n < entries_.size(); ++n) {
    const int row = static_cast<int>(n);
    if (row >= list_->topLevelItemCount()) list_->addTopLevelItem(new QTreeWidgetItem);
    show_row(*list_->topLevelItem(row), entries_[n]);
  }
  if (!list_->currentItem() && !entries_.empty()) list_->setCurrentItem(list_->topLevelItem(0));
  const Entry* const marked = chosen();
  for (QToolButton* const button : uses_) button->setEnabled(marked && marked->why_not.empty());
  margin_->setEnabled(marked && marked->why_not.empty());
  listing_ = false;
  emit listed();
}

void StructuresSection::show_row(QTreeWidgetItem& item, const Entry& entry) const {
  const bool fits = entry.why_not.empty();
  item.setText(0, structure_text(entry.structure.name));
  QPixmap swatch(12, 12);
  swatch.fill(QColor(structure_text(entry.color)));
  item.setIcon(0, QIcon(swatch));
  item.setText(1, !entry.off.empty()    ? tr("outside the scan")
                  : entry.made.measures ? volume_in_words(volume_of(entry))
                                        : QString());
  item.setFlags(fits ? Qt::ItemIsEnabled | Qt::ItemIsSelectable | Qt::ItemIsUserCheckable : Qt::ItemIsSelectable);
  item.setCheckState(0, entry.shown ? Qt::Checked : Qt::Unchecked);
  QString tip = contours_of(entry.structure) ? tr("Drawn in the scene")
                                             : structure_text(entry.structure.file.filename().string());
  if (!entry.structure.code.empty()) tip += QLatin1Char('\n') + structure_text(entry.structure.code);
  if (!fits) tip += QLatin1Char('\n') + structure_text(entry.why_not);
  if (!entry.off.empty()) tip += QLatin1Char('\n') + words(entry.off);
  for (const Text& warning : entry.structure.warnings) tip += QLatin1Char('\n') + structure_text(warning);
  item.setToolTip(0, tip);
}

/// As it is felt; null where it is not.
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

/// Measures and shapes, one after the other: first of what is shown.
void StructuresSection::make_next() {
  if (making_.is_busy() || !scan_) return;
  const auto wants = [this](bool drawn) {
    return [this, drawn](const Entry& entry) {
      if (!entry.why_not.empty()) return false;
      if (!drawn) return !entry.made.measures;
      // What is told of a correction is told of the field that is felt.
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

/// Of several the first is told; each has it in its row.
void StructuresSection::look_whether_off(Entry& entry) {
  if (!entry.made.measures || !entry.off.empty()) return;
  const bool first = std::ranges::all_of(entries_, [](const Entry& one) { return one.off.empty(); });
  entry.off =
      off_scan(entry.structure, {entry.made.measures->box_low_mm, entry.made.measures->box_high_mm}, scan_->geometry);
  if (entry.off.empty() || !first) return;
  const QString before = message_->text();
  tell(before.isEmpty() ? words(entry.off) : before + QLatin1Char('\n') + words(entry.off), true);
}

/// Where the margins of what the scene makes of a structure begin, as its distance has it.
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
    drawn.color = QColor(structure_text(entry.color));
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
    // The lines on the slices are those that are felt, also while the surface is on its way.
    drawn.distance = now->distance;
    drawn.before = is_edited(entry) ? before_edits_of(*now) : nullptr;
    if (const auto box = io::box_of_edits(now->edits)) {
      drawn.low_mm = glm::min(drawn.low_mm, box->low_mm);
      drawn.high_mm = glm::max(drawn.high_mm, box->high_mm);
    }
  }
  drawn_.set_structures(std::move(shown), opacity_->value() / 100.0);
}

void StructuresSection::use(const QString& what, const Edit& edit) {
  if (!scan_ || !chosen()) return;
  chosen()->shown = true;
  tell(tr("Reading…"), false);
  model_.edit(what, edit, [alive = QPointer(this), note = words(chosen()->off)](const QString& why) {
    if (!alive) return;
    alive->tell(why.isEmpty() ? note : why, !why.isEmpty() || !note.isEmpty());
    alive->follow_strokes();
  });
}

QString StructuresSection::in_words() const {
  const auto felt = std::ranges::count_if(entries_, [](const Entry& entry) { return entry.why_not.empty(); });
  if (entries_.empty()) return {};
  const auto others = static_cast<std::ptrdiff_t>(entries_.size()) - felt;
  return others == 0 ? QString::number(felt) : tr("%1, and %2 that cannot be felt here").arg(felt).arg(others);
}

void StructuresSection::tell(const QString& message, bool problem) {
  show_message(*message_, message, problem);
}

}  // namespace palpate::plugin
