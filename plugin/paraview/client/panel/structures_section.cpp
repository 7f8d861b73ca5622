#include "plugin/paraview/client/panel/structures_section.h"

#include <QDoubleSpinBox>
#include <QLabel>
#include <QPixmap>
#include <QPointer>
#include <QSignalBlocker>
#include <QToolButton>
#include <QTreeWidget>

#include <algorithm>
#include <string>
#include <utility>

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

QString volume_in_words(double mm3) {
  constexpr double small_ml = 10, ml = 1000;
  return QStringLiteral("%1 ml").arg(mm3 / ml, 0, 'f', mm3 / ml < small_ml ? 2 : 0);
}

}  // namespace

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

/// Lists and shows the scene's structures, in the scene's colors, whatever their source.
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
  QString tip = contours_of(entry.structure) ? tr("Made of contours that the scene contains")
                                             : structure_text(entry.structure.file.filename().string());
  if (!entry.structure.code.empty()) tip += QLatin1Char('\n') + structure_text(entry.structure.code);
  if (!fits) tip += QLatin1Char('\n') + structure_text(entry.why_not);
  if (!entry.off.empty()) tip += QLatin1Char('\n') + words(entry.off);
  for (const Text& warning : entry.structure.warnings) tip += QLatin1Char('\n') + structure_text(warning);
  item.setToolTip(0, tip);
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
  return others == 0 ? QString::number(felt) : tr("%1; %2 cannot be felt here").arg(felt).arg(others);
}

void StructuresSection::tell(const QString& message, bool problem) {
  show_message(*message_, message, problem);
}

}  // namespace palpate::plugin
