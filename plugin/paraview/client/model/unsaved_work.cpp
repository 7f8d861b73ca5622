#include "plugin/paraview/client/model/unsaved_work.h"

#include <algorithm>

#include "modes/scene/scene_json.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {
namespace {

bool is_read(const modes::Scene& scene, const std::string& structure) {
  return std::ranges::any_of(scene.modes, [&](const modes::Mode& mode) {
    return mode.structure == structure || mode.strength_structure == structure ||
           std::ranges::any_of(mode.gates, [&](const modes::Gate& gate) { return gate.structure == structure; });
  });
}

/// The felt part of a scene, without edits of outlines, additions of a running correction, and settings of the hand.
std::string work_in(modes::Scene scene) {
  const modes::Scene usual;
  scene.workspace = usual.workspace;
  scene.limits = usual.limits;
  scene.stiffness_n_per_m = usual.stiffness_n_per_m;
  snap_no_more(scene);
  for (modes::SceneStructure& one : scene.structures) one.edits.clear();
  std::erase_if(scene.structures, [&](const modes::SceneStructure& one) {
    return !one.file.empty() && !one.margin_mm && !is_read(scene, one.name);
  });
  return modes::to_json(scene);
}

std::string key_of(const modes::SceneStructure& structure) {
  const std::string segment = structure.segment_number ? std::to_string(*structure.segment_number) : structure.segment;
  return structure.name + '\n' + structure.file + '\n' + segment;
}

/// A text for each item, with its scan and all its data.
std::vector<std::string> items_of(const std::string& scan, const Marks& marks) {
  std::vector<std::string> items;
  const auto add = [&](const Marks& one) { items.push_back(kept_text({{scan, one}})); };
  for (const FeltMark& point : marks.points) add({.points = {point}, .paths = {}, .distances = {}, .angles = {}});
  for (const MarkedPath& path : marks.paths) add({.points = {}, .paths = {path}, .distances = {}, .angles = {}});
  const auto point = [&](std::size_t n) { return n < marks.points.size() ? marks.points[n] : FeltMark(); };
  for (const MarkedDistance& of : marks.distances) {
    add({.points = {point(of.from), point(of.to)}, .paths = {}, .distances = {{.from = 0, .to = 1}}, .angles = {}});
  }
  for (const MarkedAngle& of : marks.angles) {
    add({.points = {point(of.from), point(of.at), point(of.to)},
         .paths = {},
         .distances = {},
         .angles = {{.from = 0, .at = 1, .to = 2}}});
  }
  return items;
}

}  // namespace

bool UnsavedWork::is_outline_saved(const modes::SceneStructure& structure) const {
  const auto saved = outlines_.find(key_of(structure));
  if (saved != outlines_.end() && saved->second == structure.edits) return true;
  const auto& first = scene_.opened().structures;
  const auto before = std::ranges::find(first, key_of(structure), key_of);
  return structure.edits == (before == first.end() ? std::vector<io::Edit>() : before->edits);
}

Unsaved UnsavedWork::all() const {
  const modes::Scene& now = scene_.scene();
  const std::string work = work_in(now);
  Unsaved unsaved{.scene = work != work_in(scene_.opened()) && !scenes_.contains(work), .outlines = {}};
  for (const modes::SceneStructure& one : now.structures) {
    if (!is_outline_saved(one)) unsaved.outlines.push_back(one.name);
  }
  for (const auto& [scan, marks] : marks_.of_all_scans()) {
    for (const std::string& item : items_of(scan, marks)) unsaved.marks += items_.contains(item) ? 0 : 1;
  }
  return unsaved;
}

std::string UnsavedWork::text_of_all() const {
  return modes::to_json(scene_.scene()) + kept_text(marks_.of_all_scans());
}

Unsaved UnsavedWork::of_program() const {
  return all_let_go_ == text_of_all() ? Unsaved() : all();
}

Unsaved UnsavedWork::of_scan() const {
  if (scene_let_go_ == modes::to_json(scene_.scene())) return {};
  Unsaved unsaved = all();
  unsaved.marks = 0;
  return unsaved;
}

void UnsavedWork::note_scene_saved(const modes::Scene& scene) {
  scenes_.insert(work_in(scene));
  for (const modes::SceneStructure& one : scene.structures) outlines_[key_of(one)] = one.edits;
}

void UnsavedWork::note_scene_saved() {
  note_scene_saved(scene_.scene());
}

void UnsavedWork::note_state_saved() {
  if (const auto kept = scene_.kept()) note_scene_saved(*kept);
  for (const auto& [scan, marks] : marks_.of_all_scans()) note_marks_saved(scan, marks);
}

void UnsavedWork::note_outline_saved(const io::Structure& structure, const std::vector<io::Edit>& edits) {
  for (const modes::SceneStructure& one : scene_.scene().structures) {
    if (is_same(one, structure)) outlines_[key_of(one)] = edits;
  }
}

void UnsavedWork::note_marks_saved(const std::string& scan, const Marks& marks) {
  for (std::string& item : items_of(scan, marks)) items_.insert(std::move(item));
}

void UnsavedWork::let_scene_go() {
  scene_let_go_ = modes::to_json(scene_.scene());
}

void UnsavedWork::let_all_go() {
  all_let_go_ = text_of_all();
}

}  // namespace palpate::plugin
