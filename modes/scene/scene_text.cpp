#include <cmath>
#include <nlohmann/json.hpp>

#include "modes/scene/edit_json.h"
#include "modes/scene/scene_json.h"
#include "modes/scene/scene_names.h"
#include "modes/types/mode_type.h"

namespace palpate::modes {
namespace {

using Json = nlohmann::ordered_json;

Json list(const Vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

void add_function(Json& json, const TransferFunction& function) {
  Json nodes = Json::array();
  for (const Node& node : function.nodes()) {
    nodes.push_back(Json::array({node.at, node.value}));
  }
  json["nodes"] = std::move(nodes);
  if (function.interpolation() != Interpolation::linear) {
    json["interpolation"] = name_in(interpolation_names, function.interpolation());
  }
}

bool is_constant(const TransferFunction& function) {
  return function.nodes().size() == 1 && function.nodes()[0].at == 0 &&
         function.interpolation() == Interpolation::linear;
}

Json json_of_strength(const Mode& mode, const ModeType& type) {
  if (is_constant(mode.strength_n) && mode.strength_of == type.strength_of) {
    return mode.strength_n.nodes()[0].value;
  }
  Json json{{"of", name_in(datum_names, mode.strength_of)}};
  if (mode.strength_of == Datum::distance) json["structure"] = mode.strength_structure;
  add_function(json, mode.strength_n);
  return json;
}

Json json_of(const Mode& mode) {
  const ModeType& type = *find_mode_type(mode.type);
  Json json{{"type", mode.type}};
  if (!mode.name.empty()) {
    json["name"] = mode.name;
  }
  json["enabled"] = mode.enabled;
  if (!mode.color.empty()) {
    json["color"] = mode.color;
  }
  if (!mode.structure.empty()) {
    json["structure"] = mode.structure;
    if (contains(type.keys, Key::margin)) json["margin_mm"] = mode.margin_mm;
    if (contains(type.keys, Key::structure) && mode.level_mm != 0) json["level_mm"] = mode.level_mm;
  }
  if (contains(type.keys, Key::side) && mode.from.empty()) {
    json["side"] = name_in(side_names, mode.side);
  }
  if (contains(type.keys, Key::side) && !mode.from.empty()) {
    json["from"] = mode.from;
    json["to"] = mode.to;
  }
  if (contains(type.keys, Key::direction_of)) {
    json["field"] = name_in(direction_field_names, mode.direction_of);
  }
  if (contains(type.keys, Key::landmark)) {
    json["shape"] = name_in(shape_names, mode.shape);
    json["position_mm"] = list(mode.position_mm);
    if (mode.shape != Shape::point) {
      json["direction"] = list(mode.direction);
    }
  }
  json["strength_n"] = json_of_strength(mode, type);
  if (!mode.gates.empty() && contains(type.keys, Key::gates)) {
    json["gates"] = Json::array();
    for (const Gate& gate : mode.gates) {
      Json entry{{"of", name_in(datum_names, gate.of)}};
      if (gate.of == Datum::distance) entry["structure"] = gate.structure;
      add_function(entry, gate.factor);
      json["gates"].push_back(std::move(entry));
    }
  }
  return json;
}

Json json_of(const Tissue& tissue) {
  Json json{{"name", tissue.name}};
  if (std::isfinite(tissue.low)) {
    json["low"] = tissue.low;
  }
  if (std::isfinite(tissue.high)) {
    json["high"] = tissue.high;
  }
  json["softness"] = tissue.softness;
  if (!tissue.color.empty()) {
    json["color"] = tissue.color;
  }
  return json;
}

Json json_of(const SceneStructure& structure) {
  Json json{{"name", structure.name}};
  if (!structure.file.empty()) {
    json["file"] = structure.file;
    json["segment"] = structure.segment_number ? Json(*structure.segment_number) : Json(structure.segment);
  }
  if (!structure.color.empty()) {
    json["color"] = structure.color;
  }
  if (structure.margin_mm) {
    json["margin_mm"] = *structure.margin_mm;
  }
  if (!structure.edits.empty()) json["edits"] = json_of_edits(structure.edits);
  return json;
}

Json json_of(const WorkspaceSettings& workspace) {
  Json json;
  if (workspace.center_mm) {
    json["center_mm"] = list(*workspace.center_mm);
  }
  json["rotation"] =
      Json::array({list(workspace.rotation[0]), list(workspace.rotation[1]), list(workspace.rotation[2])});
  json["scale"] = workspace.scale;
  json["fit"] = workspace.fit;
  return json;
}

Json json_of(const io::Filter& filter) {
  Json json{{"type", std::string(filter.type->name)}};
  if (filter.type->reads_sigma_mm) json["sigma_mm"] = filter.sigma_mm;
  if (filter.type->reads_sigma_value) json["sigma_value"] = filter.sigma_value;
  if (filter.type->reads_width) json["width"] = filter.width;
  return json;
}

Json json_of(const Scene& scene) {
  Json json{{"version", Scene::version}, {"name", scene.name}, {"description", scene.description}};
  json["stiffness_n_per_m"] = scene.stiffness_n_per_m;
  json["limits"] = {{"force_limit_n", scene.limits.force_n},
                    {"slew_limit_n_per_ms", scene.limits.slew_n_per_ms},
                    {"ramp_s", scene.limits.ramp_s},
                    {"speed_limit_m_per_s", scene.limits.speed_m_per_s}};
  json["workspace"] = json_of(scene.workspace);
  for (const solver::SolverType* type : solver::solver_types()) {
    json["solvers"][std::string(type->name)] = scene.solvers.contains(*type);
  }
  json["subdivision"] = {{"step_mm", scene.subdivision.step_mm},
                         {"most", scene.subdivision.most},
                         {"proxy_step_mm", scene.subdivision.proxy_step_mm},
                         {"most_halts", scene.subdivision.most_halts}};
  if (scene.filter.type != nullptr) json["filter"] = json_of(scene.filter);
  json["sampling"] = {{"value", name_in(value_method_names, scene.sampling.value)},
                      {"gradient", name_in(gradient_method_names, scene.sampling.gradient)}};
  if (scene.gradient_scale_mm) {
    json["gradient_scale_mm"] = *scene.gradient_scale_mm;
  }
  if (!scene.tissues.empty()) {
    json["tissues"] = Json::array();
    for (const Tissue& tissue : scene.tissues) {
      json["tissues"].push_back(json_of(tissue));
    }
  }
  if (!scene.structures.empty()) {
    json["structures"] = Json::array();
    for (const SceneStructure& structure : scene.structures) {
      json["structures"].push_back(json_of(structure));
    }
  }
  json["modes"] = Json::array();
  for (const Mode& mode : scene.modes) {
    json["modes"].push_back(json_of(mode));
  }
  return json;
}

bool holds_object(const Json& json) {
  if (json.is_object()) {
    return true;
  }
  for (const Json& item : json) {
    if (json.is_array() && holds_object(item)) {
      return true;
    }
  }
  return false;
}

/// Bytes that are no UTF-8, such as those of a file's name in another code, become U+FFFD.
std::string in_utf8(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Like dump(2), but a list of numbers, or of nodes, stays on its line: scenes are edited by people.
void write(const Json& json, const std::string& indent, std::string& text) {
  if (json.empty() || json.is_primitive() || !holds_object(json)) {
    text += in_utf8(json);
    return;
  }
  const bool object = json.is_object();
  const std::string inner = indent + "  ";
  text += object ? '{' : '[';
  const char* separator = "\n";
  for (const auto& [key, value] : json.items()) {
    text += separator + inner + (object ? in_utf8(Json(key)) + ": " : "");
    write(value, inner, text);
    separator = ",\n";
  }
  text += '\n' + indent + (object ? '}' : ']');
}

}  // namespace

std::string to_json(const io::Filter& filter) {
  return filter.type == nullptr ? "" : json_of(filter).dump();
}

std::string to_json(const Scene& scene) {
  std::string text;
  write(json_of(scene), "", text);
  return text + "\n";
}

}  // namespace palpate::modes
