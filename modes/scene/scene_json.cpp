#include "modes/scene/scene_json.h"

#include <limits>
#include <stdexcept>

#include "modes/messages.h"
#include "modes/scene/edit_json.h"
#include "modes/scene/json_reader.h"
#include "modes/scene/json_text.h"
#include "modes/scene/scene_names.h"
#include "modes/types/mode_type.h"

namespace palpate::modes {
namespace {

template <typename Names>
auto choice(const At& at, const Names& names) {
  const std::string name = text(at);
  std::string known;
  for (const auto& entry : names) {
    if (entry.name == name) {
      return entry.value;
    }
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  refuse(at.path, say("there-is-no-such-name", name, known));
}

/// Reads nodes and interpolation from the members of an object that may hold other keys too. `what` names the
/// quantity of the values.
TransferFunction transfer_function(Members& members, const std::string& what) {
  const At list = members.get("nodes");
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < length_of_array(list); ++i) {
    const At node = list[i];
    length_of_array(node, 2);
    nodes.push_back({number(node[0]), number(node[1])});
    if (nodes.back().value < 0) {
      refuse(node[1].path, say("negative-value", number_text(nodes.back().value), what));
    }
  }
  Interpolation interpolation = Interpolation::linear;
  members.optional("interpolation", interpolation, [](const At& at) { return choice(at, interpolation_names); });
  try {
    return TransferFunction(std::move(nodes), interpolation);
  } catch (const InvalidInput& error) {
    throw InvalidInput(at_place(members.path_of(""), error.text(), ""));
  }
}

/// Whose distance is read: the structure that is named there, or the mode's own.
std::string structure_of(Members& members, Datum of, const Mode& mode) {
  if (of != Datum::distance) {
    return {};
  }
  return members.has("structure") || mode.structure.empty() ? text(members.get("structure")) : mode.structure;
}

/// A number: the same strength everywhere; or an object.
void read_strength(const At& at, Mode& mode) {
  if (at.value.is_number()) {
    mode.strength_n = TransferFunction(number(at));
    return;
  }
  Members members(at);
  members.optional("of", mode.strength_of, [](const At& of) { return choice(of, datum_names); });
  mode.strength_structure = structure_of(members, mode.strength_of, mode);
  mode.strength_n = transfer_function(members, "a strength is in newtons");
  members.done();
}

std::vector<Gate> read_gates(const At& at, const Mode& mode) {
  std::vector<Gate> gates;
  for (std::size_t i = 0; i < length_of_array(at); ++i) {
    Members members(at[i]);
    Gate gate;
    gate.of = choice(members.get("of"), datum_names);
    gate.structure = structure_of(members, gate.of, mode);
    gate.factor = transfer_function(members, "a gate is a factor");
    members.done();
    gates.push_back(std::move(gate));
  }
  return gates;
}

void read_side_or_tissues(Members& members, Mode& mode) {
  const bool pair = mode.structure.empty() && (members.has("from") || members.has("to"));
  if (!pair) {
    members.optional("side", mode.side, [](const At& at) { return choice(at, side_names); });
    return;
  }
  if (members.has("side")) {
    refuse(members.path_of("side"), say("side-follows-from-the-tissues"));
  }
  mode.from = text(members.get("from"));
  mode.to = text(members.get("to"));
}

void read_landmark(Members& members, Mode& mode) {
  mode.shape = choice(members.get("shape"), shape_names);
  mode.position_mm = vector3(members.get("position_mm"));
  if (mode.shape != Shape::point) {
    mode.direction = vector3(members.get("direction"));
  }
}

Mode read_mode(const At& at) {
  Members members(at);
  Mode mode;
  mode.type = text(members.get("type"));
  const ModeType* type = find_mode_type(mode.type);
  if (type == nullptr) {
    refuse(members.path_of("type"), say("there-is-no-mode", mode.type, mode_type_names()));
  }
  members.optional("name", mode.name, text);
  members.optional("enabled", mode.enabled, boolean);
  members.optional("color", mode.color, text);
  if (contains(type->keys, Key::margin)) {
    mode.structure = text(members.get("structure"));
    members.optional("margin_mm", mode.margin_mm, number);
  }
  if (contains(type->keys, Key::structure)) {
    members.optional("structure", mode.structure, text);
    if (!mode.structure.empty()) members.optional("level_mm", mode.level_mm, number);
  }
  mode.strength_of = type->strength_of;
  read_strength(members.get("strength_n"), mode);
  if (contains(type->keys, Key::gates)) {
    members.optional("gates", mode.gates, [&mode](const At& gates) { return read_gates(gates, mode); });
  }
  if (contains(type->keys, Key::side)) {
    read_side_or_tissues(members, mode);
  }
  if (contains(type->keys, Key::direction_of)) {
    members.optional("field", mode.direction_of, [](const At& field) { return choice(field, direction_field_names); });
  }
  if (contains(type->keys, Key::landmark)) {
    read_landmark(members, mode);
  }
  members.done();
  return mode;
}

Tissue read_tissue(const At& at) {
  Members members(at);
  Tissue tissue;
  tissue.name = text(members.get("name"));
  tissue.low = -std::numeric_limits<double>::infinity();
  tissue.high = std::numeric_limits<double>::infinity();
  members.optional("low", tissue.low, number);
  members.optional("high", tissue.high, number);
  tissue.softness = number(members.get("softness"));
  members.optional("color", tissue.color, text);
  members.done();
  return tissue;
}

SceneStructure read_structure(const At& at) {
  Members members(at);
  SceneStructure structure;
  structure.name = text(members.get("name"));
  // Without a file, the contours of the edits must define the structure. validate() checks this.
  members.optional("file", structure.file, text);
  if (members.has("segment")) {
    const At segment = members.get("segment");
    if (segment.value.is_number()) {
      structure.segment_number = integer(segment);
    } else {
      structure.segment = text(segment);
    }
  }
  members.optional("color", structure.color, text);
  members.optional("margin_mm", structure.margin_mm, number);
  members.optional("edits", structure.edits, edits_at);
  members.done();
  return structure;
}

WorkspaceSettings read_workspace(const At& at) {
  Members members(at);
  WorkspaceSettings workspace;
  members.optional("center_mm", workspace.center_mm, vector3);
  members.optional("rotation", workspace.rotation, [](const At& rotation) {
    length_of_array(rotation, 3);
    return glm::dmat3(vector3(rotation[0]), vector3(rotation[1]), vector3(rotation[2]));
  });
  members.optional("scale", workspace.scale, number);
  members.optional("fit", workspace.fit, boolean);
  members.done();
  return workspace;
}

Limits read_limits(const At& at) {
  Members members(at);
  Limits limits;
  members.optional("force_limit_n", limits.force_n, number);
  members.optional("slew_limit_n_per_ms", limits.slew_n_per_ms, number);
  members.optional("ramp_s", limits.ramp_s, number);
  members.optional("speed_limit_m_per_s", limits.speed_m_per_s, number);
  members.done();
  return limits;
}

solver::SolverSet read_solvers(const At& at) {
  Members members(at);
  solver::SolverSet solvers = solver::SolverSet::usual();
  for (const solver::SolverType* type : solver::solver_types()) {
    bool is_on = solvers.contains(*type);
    members.optional(std::string(type->name), is_on, boolean);
    solvers.set(*type, is_on);
  }
  members.done();
  return solvers;
}

Subdivision read_subdivision(const At& at) {
  Members members(at);
  Subdivision subdivision;
  members.optional("step_mm", subdivision.step_mm, number);
  members.optional("most", subdivision.most, integer);
  members.optional("proxy_step_mm", subdivision.proxy_step_mm, number);
  members.optional("most_halts", subdivision.most_halts, integer);
  members.done();
  return subdivision;
}

Sampling read_sampling(const At& at) {
  Members members(at);
  Sampling sampling;
  members.optional("value", sampling.value, [](const At& value) { return choice(value, value_method_names); });
  members.optional("gradient", sampling.gradient,
                   [](const At& gradient) { return choice(gradient, gradient_method_names); });
  members.done();
  return sampling;
}

io::Filter read_filter(const At& at) {
  Members members(at);
  io::Filter filter;
  std::vector<Named<const io::FilterType*>> names{{nullptr, "none"}};
  for (const io::FilterType* const type : io::filter_types()) names.push_back({type, type->name});
  filter.type = choice(members.get("type"), names);
  if (filter.type != nullptr) {
    if (filter.type->reads_sigma_mm) members.optional("sigma_mm", filter.sigma_mm, number);
    if (filter.type->reads_sigma_value) members.optional("sigma_value", filter.sigma_value, number);
    if (filter.type->reads_width) members.optional("width", filter.width, integer);
  }
  members.done();
  return filter;
}

template <typename Item>
std::vector<Item> read_list(const At& at, Item (*read)(const At&)) {
  std::vector<Item> items;
  for (std::size_t i = 0; i < length_of_array(at); ++i) {
    items.push_back(read(at[i]));
  }
  return items;
}

Scene read_scene(const nlohmann::json& json) {
  Members members({json, ""});
  const int version = integer(members.get("version"));
  if (version != Scene::version) {
    refuse("version", say("not-known", version, Scene::version));
  }
  Scene scene;
  members.optional("name", scene.name, text);
  members.optional("description", scene.description, text);
  members.optional("stiffness_n_per_m", scene.stiffness_n_per_m, number);
  members.optional("limits", scene.limits, read_limits);
  members.optional("workspace", scene.workspace, read_workspace);
  members.optional("solvers", scene.solvers, read_solvers);
  members.optional("subdivision", scene.subdivision, read_subdivision);
  members.optional("filter", scene.filter, read_filter);
  members.optional("sampling", scene.sampling, read_sampling);
  members.optional("gradient_scale_mm", scene.gradient_scale_mm, number);
  members.optional("tissues", scene.tissues, [](const At& at) { return read_list(at, read_tissue); });
  members.optional("structures", scene.structures, [](const At& at) { return read_list(at, read_structure); });
  scene.modes = read_list(members.get("modes"), read_mode);
  members.done();
  return scene;
}

}  // namespace

Scene scene_from_json(std::string_view text, const std::string& source) {
  return read_from(source, [&] {
    Scene scene = read_scene(parsed(text));
    validate(scene);
    return scene;
  });
}

io::Filter filter_from_json(std::string_view text) {
  if (text.empty()) return {};
  return read_from("filter", [&] {
    const io::Filter filter = read_filter({parsed(text), ""});
    io::validate(filter);
    return filter;
  });
}

}  // namespace palpate::modes
