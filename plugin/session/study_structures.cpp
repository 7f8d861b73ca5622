#include "plugin/session/study_structures.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "modes/types/mode_type.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

constexpr double boundary_n = 1.0;
constexpr double keep_out_n = 2.0;

template <typename Named>
std::string unused(const std::vector<Named>& all, const std::string& wanted) {
  std::string name = wanted;
  const auto has = [&](const Named& one) { return one.name == name; };
  for (int n = 2; std::any_of(all.begin(), all.end(), has); ++n) name = wanted + " " + std::to_string(n);
  return name;
}

modes::Mode mode_of(const modes::Scene& scene, const std::string& type, const std::string& name,
                    const std::string& structure, double newtons) {
  modes::Mode mode;
  mode.type = type;
  mode.strength_of = modes::find_mode_type(type)->strength_of;
  mode.name = unused(scene.modes, name);
  mode.structure = structure;
  mode.strength_n = modes::TransferFunction(newtons);
  const auto of = std::find_if(scene.structures.begin(), scene.structures.end(),
                               [&](const modes::SceneStructure& one) { return one.name == structure; });
  mode.color = of == scene.structures.end() ? std::string() : of->color;
  return mode;
}

}  // namespace

Text why_not_on(const io::Structure& structure, const io::Volume& scan) {
  if (!structure.unfit.empty()) return structure.unfit;
  if (!structure.frame_of_reference_uid.empty() && !scan.frame_of_reference_uid.empty() &&
      structure.frame_of_reference_uid != scan.frame_of_reference_uid) {
    return say("another-frame-of-reference", structure.file.filename().string());
  }
  return {};
}

bool is_same(const modes::SceneStructure& named, const io::Structure& structure) {
  if (std::filesystem::path(named.file) != structure.file) return false;
  return named.segment_number ? *named.segment_number == structure.number : named.segment == structure.name;
}

std::string name_in_scene(modes::Scene& scene, const io::Structure& structure) {
  for (const modes::SceneStructure& named : scene.structures) {
    if (is_same(named, structure)) return named.name;
  }
  modes::SceneStructure added;
  added.name = unused(scene.structures, structure.name.empty() ? "structure" : structure.name);
  added.file = structure.file.string();
  added.segment_number = structure.number;
  added.color = structure.color;
  scene.structures.push_back(added);
  return added.name;
}

void add_boundary_of(modes::Scene& scene, const io::Structure& structure) {
  const std::string name = name_in_scene(scene, structure);
  scene.modes.push_back(mode_of(scene, "surface", name, name, boundary_n));
}

void add_keep_out_of(modes::Scene& scene, const io::Structure& structure, double margin_mm) {
  const std::string name = name_in_scene(scene, structure);
  modes::Mode mode = mode_of(scene, "keep_out", "Keep out of " + name, name, keep_out_n);
  mode.margin_mm = margin_mm;
  scene.modes.push_back(mode);
  for (modes::SceneStructure& one : scene.structures) {
    if (one.name == name) one.margin_mm = margin_mm;
  }
}

void add_gate_of(modes::Scene& scene, std::size_t mode, const io::Structure& structure) {
  const std::string name = name_in_scene(scene, structure);
  modes::Gate gate;
  gate.of = modes::Datum::distance;
  gate.structure = name;
  gate.factor = modes::TransferFunction({{0, 0}, {1, 1}});
  scene.modes.at(mode).gates.push_back(gate);
}

}  // namespace palpate::plugin
