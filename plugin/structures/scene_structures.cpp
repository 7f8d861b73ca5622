#include "plugin/structures/scene_structures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>

#include "io/errors.h"
#include "io/structures/outline_change.h"
#include "io/structures/structure.h"
#include "plugin/messages/messages.h"
#include "plugin/structures/named_structure.h"
#include "plugin/structures/same_space.h"
#include "plugin/structures/shared_distance.h"
#include "plugin/structures/shared_edits.h"
#include "plugin/structures/structure_files.h"
#include "plugin/structures/study_registrations.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {
namespace {

/// In steps, so that a margin that is being dragged does not ask for another field at each of them.
constexpr std::array reaches_mm{3.0, 5.0, 8.0, 12.0, 20.0};

/// How far from a structure's surface something changes with the distance, mm. It follows from the scene alone: a
/// recording of it is repeated on the same field.
double reach_of(const modes::Scene& scene, const modes::SceneStructure& structure) {
  double reach = structure.margin_mm.value_or(0) + 1;
  const auto take = [&](const std::string& name, modes::Datum of, const modes::TransferFunction& function) {
    if (of != modes::Datum::distance || name != structure.name) return;
    for (const modes::Node& node : function.nodes()) reach = std::max(reach, std::abs(node.at) + 1);
  };
  for (const modes::Mode& mode : scene.modes) {
    if (mode.structure == structure.name) {
      reach = std::max({reach, mode.margin_mm + 1, std::abs(mode.level_mm) + 2});
    }
    take(mode.strength_structure, mode.strength_of, mode.strength_n);
    for (const modes::Gate& gate : mode.gates) take(gate.structure, gate.of, gate.factor);
  }
  const auto* const enough =
      std::find_if(reaches_mm.begin(), reaches_mm.end(), [&](double step) { return step >= reach; });
  return enough == reaches_mm.end() ? reaches_mm.back() : *enough;
}

[[noreturn]] void refuse(const modes::SceneStructure& structure, const Text& why) {
  throw InvalidInput(at_place("structure \"" + structure.name + "\"", why));
}

io::Structure find_structure(const modes::SceneStructure& wanted, const std::filesystem::path& file) {
  io::StructureCatalogue catalogue;
  try {
    catalogue = io::find_structures(std::array{copy_of(file)});
  } catch (const io::DicomError& error) {
    refuse(wanted, error.text());
  }
  if (catalogue.structures.empty()) {
    const std::string why = catalogue.skipped.empty() ? "" : ": " + catalogue.skipped.front().reason;
    refuse(wanted, say("file-holds-no-structures", file.filename().string(), why));
  }
  for (io::Structure& structure : catalogue.structures) structure.file = file;
  AskedStructure asked{.number = wanted.segment_number, .name = std::nullopt};
  if (!wanted.segment_number) asked.name = wanted.segment;
  const FoundStructure found = find_named(catalogue.structures, asked, file);
  if (found.structure == nullptr) refuse(wanted, found.why_not);
  return *found.structure;
}

/// What else its file says of it, `palpate structures` tells.
void keep_what_is_to_be_checked(io::Structure& structure) {
  if (structure.kind != io::StructureKind::label_map) structure.warnings.clear();
  // That it names no scan: it may be another patient's.
  for (Text& warning : structure.warnings) warning = at_place(structure.file.filename().string(), warning);
}

/// Puts it on the scan, by a registration if that is needed: the recorded one, or the study's.
std::optional<RegisteredStructure> place(io::Structure& structure, const modes::SceneStructure& wanted,
                                         const io::Volume& volume, std::span<const RegisteredStructure> recorded,
                                         StudyRegistrations& study) {
  const auto known = std::ranges::find(recorded, wanted.name, &RegisteredStructure::structure);
  if (known != recorded.end()) {
    if (const Text why = place_by(structure, known->motion, volume); !why.empty()) refuse(wanted, why);
    return *known;
  }
  const Placed placed = place_on(structure, study.beside(structure, volume), volume);
  if (!placed.why_not.empty()) refuse(wanted, placed.why_not);
  if (placed.registration.empty()) return std::nullopt;
  return RegisteredStructure{
      .structure = wanted.name, .file_hash = hash_of_file(placed.registration), .motion = structure.motion};
}

/// A structure that the scene's own contours make.
LoadedStructure load_drawn(const modes::SceneStructure& wanted, const io::Geometry& scan, double reach_mm) {
  const io::Edit& first = wanted.edits.front();
  try {
    std::vector<Text> warnings;
    io::Structure drawn;
    drawn.name = wanted.name;
    drawn.file = "scene";
    if (const auto box = io::box_of_edits(std::array{first})) {
      if (const Text off = off_scan(drawn, *box, scan); !off.empty()) warnings.push_back(off);
    }
    return {.file = {},
            .hash = {},
            .segment = {},
            .warnings = warnings,
            .registered = {},
            .distance = shared_distance(std::get<io::ContoursEdit>(first), scan, reach_mm),
            .edits = {first},
            .before_edits = {nullptr}};
  } catch (const InvalidInput& error) {
    refuse(wanted, at_place("edit 1", error.text()));
  }
}

/// Brings a structure to the scene's edits: from the last edit on that both have, or from the outline of its file. One
/// that is drawn begins with the field of its contours.
void edit(LoadedStructure& structure, const modes::SceneStructure& wanted,
          const std::shared_ptr<const io::Volume>& volume) {
  std::vector<std::shared_ptr<const io::DistanceField>> fields = std::move(structure.before_edits);
  fields.push_back(structure.distance);
  const auto [first_other, ignored] = std::ranges::mismatch(structure.edits, wanted.edits);
  fields.resize(static_cast<std::size_t>(first_other - structure.edits.begin()) + 1);
  for (std::size_t n = fields.size() - 1; n < wanted.edits.size(); ++n) {
    try {
      fields.push_back(shared_edited(fields.back(), wanted.edits[n], volume));
    } catch (const InvalidInput& error) {
      refuse(wanted, at_place(fmt::format("edit {}", n + 1), error.text()));
    }
  }
  structure.edits = wanted.edits;
  structure.distance = fields.back();
  fields.pop_back();
  structure.before_edits = std::move(fields);
}

std::string segment_of(const modes::SceneStructure& wanted) {
  return wanted.segment_number ? fmt::format("#{}", *wanted.segment_number) : wanted.segment;
}

std::size_t common_edits(const modes::SceneStructure& wanted, const LoadedStructure& known) {
  return static_cast<std::size_t>(std::ranges::mismatch(wanted.edits, known.edits).in1 - wanted.edits.begin());
}

/// The loaded structure with the same outline and reach, and the most of the scene's edits; null: there is none.
/// Another program may write its file while it is felt: what was read stays felt, as it is shown.
const LoadedStructure* find_loaded(const modes::SceneStructure& wanted, double reach_mm,
                                   const std::vector<LoadedStructure>& before) {
  const std::string file = std::filesystem::path(wanted.file).string(), segment = segment_of(wanted);
  const LoadedStructure* best = nullptr;
  for (const LoadedStructure& one : before) {
    const bool same = modes::is_drawn(wanted) ? one.file.empty() && one.edits.front() == wanted.edits.front()
                                              : one.file == file && one.segment == segment;
    if (!same || one.distance->reach_mm() != reach_mm) continue;
    if (best == nullptr || common_edits(wanted, one) > common_edits(wanted, *best)) best = &one;
  }
  return best;
}

}  // namespace

std::vector<LoadedStructure> carried_over(const std::vector<LoadedStructure>& structures, const io::Volume& from,
                                          const io::Volume& to) {
  if (!have_same_space(from, to) || !same_place(from.geometry, to.geometry)) return {};
  std::vector<LoadedStructure> carried = structures;
  for (LoadedStructure& one : carried) {
    const auto first = std::ranges::find_if(
        one.edits, [](const io::Edit& edit) { return std::holds_alternative<io::ScanEdgeEdit>(edit); });
    if (first == one.edits.end()) continue;
    const auto kept = static_cast<std::size_t>(first - one.edits.begin());
    one.distance = one.before_edits[kept];
    one.edits.resize(kept);
    one.before_edits.resize(kept);
  }
  return carried;
}

bool are_loaded(const modes::Scene& scene, const modes::Plan& plan, const std::vector<LoadedStructure>& before) {
  return std::ranges::all_of(plan.structures, [&](std::size_t n) {
    const modes::SceneStructure& wanted = scene.structures[n];
    const LoadedStructure* const known = find_loaded(wanted, reach_of(scene, wanted), before);
    // Its fields are kept after each of its edits.
    return known != nullptr && common_edits(wanted, *known) == wanted.edits.size();
  });
}

std::vector<LoadedStructure> load_structures(const modes::Scene& scene, const modes::Plan& plan,
                                             const io::Volume& volume, const std::vector<LoadedStructure>& before,
                                             std::span<const RegisteredStructure> recorded) {
  const std::shared_ptr<const io::Volume> not_owned(std::shared_ptr<void>(), &volume);
  return load_structures(scene, plan, not_owned, before, recorded);
}

std::vector<LoadedStructure> load_structures(const modes::Scene& scene, const modes::Plan& plan,
                                             const std::shared_ptr<const io::Volume>& scan,
                                             const std::vector<LoadedStructure>& before,
                                             std::span<const RegisteredStructure> recorded) {
  const io::Volume& volume = *scan;
  std::vector<LoadedStructure> loaded;
  StudyRegistrations study;
  for (const std::size_t n : plan.structures) {
    const modes::SceneStructure& wanted = scene.structures[n];
    const std::filesystem::path file = wanted.file;
    const double reach = reach_of(scene, wanted);
    if (const LoadedStructure* const known = find_loaded(wanted, reach, before)) {
      loaded.push_back(*known);
      edit(loaded.back(), wanted, scan);
      continue;
    }
    if (modes::is_drawn(wanted)) {
      loaded.push_back(load_drawn(wanted, volume.geometry, reach));
      edit(loaded.back(), wanted, scan);
      continue;
    }
    const std::string hash = hash_of_file(copy_of(file));
    io::Structure structure = find_structure(wanted, file);
    keep_what_is_to_be_checked(structure);
    const std::optional<RegisteredStructure> registered = place(structure, wanted, volume, recorded, study);
    try {
      if (const Text off = off_scan(structure, io::box_of(structure), volume.geometry); !off.empty()) {
        structure.warnings.push_back(off);
      }
      loaded.push_back({file.string(), hash, segment_of(wanted), structure.warnings, registered,
                        shared_distance(structure, volume.geometry, reach)});
      if (hash_of_file(copy_of(file)) != hash) {
        refuse(wanted, say("structure-rewritten-while-read", file.filename().string()));
      }
      edit(loaded.back(), wanted, scan);
    } catch (const io::DicomError& error) {
      refuse(wanted, error.text());
    }
  }
  return loaded;
}

}  // namespace palpate::plugin
