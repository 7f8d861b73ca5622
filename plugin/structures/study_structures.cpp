#include "plugin/structures/study_structures.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
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

/// Whether two agree; nothing if one of them is not said.
std::optional<bool> agree(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return std::nullopt;
  return a == b;
}

/// A person's name (PN) as far as programs agree on how to write it: its letters, without its other writings.
std::string plain(const std::string& name) {
  std::string letters;
  for (const char letter : name.substr(0, name.find('='))) {
    const auto byte = static_cast<unsigned char>(letter);
    if (byte >= 0x80 || std::isalnum(byte) != 0) letters += static_cast<char>(std::tolower(byte));
  }
  return letters;
}

// No id of a patient begins so: it is not the letters that it hashes.
constexpr const char* hash_mark = "xxh3:";

bool is_hashed(const std::string& text) {
  return text.starts_with(hash_mark);
}

std::string hashed(const std::string& text) {
  if (text.empty() || is_hashed(text)) return text;
  return fmt::format("{}{:016x}", hash_mark, XXH3_64bits(text.data(), text.size()));
}

/// Why it cannot be felt on any scan, or on one of this patient. Adds what is to be known of that to its warnings.
Text unfit_for(io::Structure& structure, const io::Volume& scan) {
  const std::string file = structure.file.filename().string();
  if (!structure.unfit.empty()) {
    return at_place(fmt::format("{}: {} \"{}\"", file, io::name_of(structure.kind), structure.name), structure.unfit);
  }
  const auto has_same_id = is_hashed(scan.patient_id) ? agree(hashed_id(structure.patient_id), scan.patient_id)
                                                      : agree(structure.patient_id, scan.patient_id);
  const auto has_same_name = is_hashed(scan.patient_name)
                                 ? agree(hashed_name(structure.patient_name), scan.patient_name)
                                 : agree(plain(structure.patient_name), plain(scan.patient_name));
  const bool differs = has_same_id == false || has_same_name == false;
  if (differs && has_same_id != true && has_same_name != true) {
    return has_same_id ? say("structure-of-another-patient", file) : say("structure-of-another-patient-by-name", file);
  }
  if (differs) structure.warnings.push_back(say("structure-of-a-patient-of-another-name", file));
  return {};
}

/// Whatever has its margin outside a structure.
bool keeps_out(const modes::Mode& mode) {
  const modes::ModeType* const type = modes::find_mode_type(mode.type);
  return type && contains(type->keys, modes::Key::margin) && type->margin_side > 0;
}

}  // namespace

std::string hashed_id(const std::string& id) {
  return hashed(id);
}

std::string hashed_name(const std::string& name) {
  return is_hashed(name) ? name : hashed(plain(name));
}

Text place_by(io::Structure& structure, const io::RigidMotion& motion, const io::Volume& scan) {
  Text why_not = unfit_for(structure, scan);
  if (!why_not.empty()) return why_not;
  structure.motion = motion;
  structure.frame_of_reference_uid = scan.frame_of_reference_uid;
  return {};
}

Placed place_on(io::Structure& structure, std::span<const io::Registration> registrations, const io::Volume& scan) {
  if (const Text why_not = unfit_for(structure, scan); !why_not.empty()) return {.why_not = why_not};
  if (agree(structure.frame_of_reference_uid, scan.frame_of_reference_uid).value_or(true)) return {};
  const std::string file = structure.file.filename().string();
  const io::Joined joined =
      io::join(registrations, structure.frame_of_reference_uid, scan.frame_of_reference_uid, structure.patient_id);
  if (!joined.motion) {
    return {.why_not = joined.why_not.empty() ? say("another-frame-of-reference", file) : joined.why_not};
  }
  structure.motion = io::after(structure.motion, *joined.motion);
  structure.frame_of_reference_uid = scan.frame_of_reference_uid;
  structure.warnings.push_back(say("structure-is-registered", file, joined.file.filename().string()));
  return {.why_not = {}, .registration = joined.file};
}

Text off_scan(const io::Structure& structure, const io::StructureBox& box, const io::Geometry& scan) {
  if (!io::is_off(box, scan)) return {};
  return say("structure-lies-off-the-scan", structure.file.filename().string(), structure.name);
}

bool is_same(const modes::SceneStructure& named, const io::Structure& structure) {
  if (modes::is_drawn(named)) return structure.file.empty() && named.name == structure.name;
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

std::optional<double> keep_out_of(const modes::Scene& scene, const io::Structure& structure) {
  std::optional<double> widest;
  for (const modes::SceneStructure& named : scene.structures) {
    if (!is_same(named, structure)) continue;
    for (const modes::Mode& mode : scene.modes) {
      if (!mode.enabled || !keeps_out(mode) || mode.structure != named.name) continue;
      widest = std::max(widest.value_or(0), mode.margin_mm);
    }
  }
  return widest;
}

void add_gate_of(modes::Scene& scene, std::size_t mode, const io::Structure& structure) {
  const std::string name = name_in_scene(scene, structure);
  modes::Gate gate;
  gate.of = modes::Datum::distance;
  gate.structure = name;
  gate.factor = modes::TransferFunction({{0, 0}, {1, 1}});
  scene.modes.at(mode).gates.push_back(gate);
}

namespace {

std::string name_of_snap(const std::string& structure) {
  return "Scan's edge at " + structure;
}

/// Of the planes of landmarks that push to the normal's side, and to the other.
std::string name_of_side(const std::string& structure, bool along) {
  return fmt::format("Slice at {}, {} side", structure, along ? "one" : "other");
}

bool is_of_snap(const modes::Mode& mode, const std::string& structure) {
  if (modes::reads_key(mode, modes::Key::tissues)) return mode.name == name_of_snap(structure);
  return modes::reads_key(mode, modes::Key::landmark) &&
         (mode.name == name_of_side(structure, true) || mode.name == name_of_side(structure, false));
}

/// Acts near a structure's outline, where the scan's edge is looked for.
modes::Gate gate_near(const std::string& structure) {
  constexpr double within_mm = 6;
  return {.of = modes::Datum::distance,
          .factor = modes::TransferFunction({{-within_mm, 0}, {1 - within_mm, 1}, {within_mm - 1, 1}, {within_mm, 0}}),
          .structure = structure};
}

void hold_in(modes::Scene& scene, const std::string& structure, const HeldPlane& plane) {
  constexpr double plane_n = 6;  // the sum of what the hand and the held edge push it away with
  for (const bool along : {true, false}) {
    modes::Mode mode = mode_of(scene, "landmark", name_of_side(structure, along), structure, plane_n);
    mode.structure.clear();
    mode.shape = modes::Shape::plane;
    mode.position_mm = plane.point_mm;
    mode.direction = along ? plane.normal : -plane.normal;
    mode.gates.push_back(gate_near(structure));
    scene.modes.push_back(std::move(mode));
  }
}

}  // namespace

void snap_no_more(modes::Scene& scene, const io::Structure& structure) {
  for (const modes::SceneStructure& named : scene.structures) {
    if (!is_same(named, structure)) continue;
    std::erase_if(scene.modes, [&](const modes::Mode& mode) { return is_of_snap(mode, named.name); });
  }
}

bool snap_no_more(modes::Scene& scene) {
  return std::erase_if(scene.modes, [&](const modes::Mode& mode) {
           return std::ranges::any_of(scene.structures,
                                      [&](const modes::SceneStructure& named) { return is_of_snap(mode, named.name); });
         }) > 0;
}

std::optional<HeldPlane> held_plane(const modes::Scene& scene, const io::Structure& structure) {
  for (const modes::SceneStructure& named : scene.structures) {
    if (!is_same(named, structure)) continue;
    for (const modes::Mode& mode : scene.modes) {
      if (!modes::reads_key(mode, modes::Key::landmark) || mode.name != name_of_side(named.name, true)) continue;
      return HeldPlane{.point_mm = mode.position_mm, .normal = mode.direction};
    }
  }
  return std::nullopt;
}

void snap_to_scan(modes::Scene& scene, const io::Structure& structure, const Snap& snap) {
  constexpr double usual_ct_per_mm = 80;
  constexpr double least_part = 0.2, whole_part = 0.5;  // of an edge's steepness: where it begins to hold, and holds
  constexpr double sets_in = 0.05;                      // of its rise, to both sides of the middle
  const std::string name = name_in_scene(scene, structure);
  snap_no_more(scene, structure);
  const OutlineEdges& edges = snap.edges;
  const double steep = edges.per_mm > 0 ? edges.per_mm : usual_ct_per_mm;
  modes::Mode mode = mode_of(scene, "surface", name_of_snap(name), name, snap.newtons);
  mode.structure.clear();  // the scan's edge, not the outline
  mode.side = edges.rise == 0 ? modes::Side::both : edges.rise > 0 ? modes::Side::entering : modes::Side::leaving;
  mode.strength_n = modes::TransferFunction({{least_part * steep, 0}, {whole_part * steep, snap.newtons}});
  mode.gates.push_back(gate_near(name));
  if (edges.rise != 0) {
    const double half = sets_in * std::abs(edges.rise), inside = edges.rise > 0 ? 1 : 0;
    mode.gates.push_back(
        {.of = modes::Datum::value,
         .factor = modes::TransferFunction({{edges.middle - half, 1 - inside}, {edges.middle + half, inside}})});
  }
  scene.modes.push_back(std::move(mode));
  if (snap.plane) hold_in(scene, name, *snap.plane);
}

}  // namespace palpate::plugin
