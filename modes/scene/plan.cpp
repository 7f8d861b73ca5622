#include "modes/scene/plan.h"

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "modes/messages.h"
#include "modes/scene/boundary.h"
#include "modes/types/keep.h"

namespace palpate::modes {
namespace {

struct FieldName {
  io::FieldSet field;
  const char* name;
  const char* cost;
};
constexpr FieldName field_names[] = {
    {io::FieldSet::value, "value", "one interpolation a sub-step; once a tick it is read all the same, to be shown"},
    {io::FieldSet::gradient, "gradient", "one gradient sample a tick, and its bricks"},
    {io::FieldSet::vector, "vector field", "one vector sample a tick"},
    {io::FieldSet::tube, "Hessian", "six second derivatives a tick, and their bricks"},
    {io::FieldSet::low_high, "low and high", "one boundary search a tick, and its bricks"},
    {io::FieldSet::distance, "distance", "one interpolation a structure in every sub-step"}};

std::string words(io::FieldSet fields) {
  std::string text;
  for (const std::string& name : names_of(fields)) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

io::FieldSet without(io::FieldSet set, io::FieldSet taken) {
  return static_cast<io::FieldSet>(static_cast<unsigned>(set) & ~static_cast<unsigned>(taken));
}

/// "surface "skin"", or "modes[2] (surface)" where it has no name.
std::string name_of(const Mode& mode, std::size_t index) {
  return mode.name.empty() ? mode.type + " (modes[" + std::to_string(index) + "])"
                           : mode.type + " \"" + mode.name + "\"";
}

std::string saved_by(const ModeType& type) {
  return "its strength and its primitive in every tick (" + std::string(type.name) + ")";
}

/// The mode's gates, those of its pair of tissues included, and the side it resists.
void add_boundary(const Scene& scene, Mode& mode) {
  if (mode.from.empty()) {
    return;
  }
  const auto tissue = [&scene](const std::string& name) -> const Tissue& {
    return *std::find_if(scene.tissues.begin(), scene.tissues.end(),
                         [&name](const Tissue& t) { return t.name == name; });
  };
  const Boundary boundary = boundary_between(tissue(mode.from), tissue(mode.to));
  mode.gates.insert(mode.gates.end(), boundary.gates.begin(), boundary.gates.end());
  mode.side = boundary.side;
}

/// Of the structures that a scene's modes read: where the distance of each is in a sample.
class StructureIndex {
 public:
  StructureIndex(const Scene& scene, std::vector<std::size_t>& read) : scene_(scene), read_(read) {}

  std::size_t operator()(const std::string& name) {
    const auto found = std::find_if(scene_.structures.begin(), scene_.structures.end(),
                                    [&name](const SceneStructure& structure) { return structure.name == name; });
    const auto of_scene = static_cast<std::size_t>(found - scene_.structures.begin());
    const auto known = std::find(read_.begin(), read_.end(), of_scene);
    const auto index = static_cast<std::size_t>(known - read_.begin());
    if (known == read_.end()) read_.push_back(of_scene);
    return index;
  }

 private:
  const Scene& scene_;
  std::vector<std::size_t>& read_;
};

void check_count(const std::vector<std::size_t>& structures) {
  if (structures.size() > io::most_structures) throw InvalidInput(say("too-many-structures", io::most_structures));
}

/// A structure with a margin is told of, whether or not it is felt; what nothing reads is left out.
void add_watched_structures(const Scene& scene, Plan& plan) {
  StructureIndex index(scene, plan.structures);
  for (const SceneStructure& structure : scene.structures) {
    if (structure.margin_mm) {
      index(structure.name);
      plan.fields = plan.fields | io::FieldSet::distance;
    }
  }
  check_count(plan.structures);
  for (std::size_t i = 0; i < scene.structures.size(); ++i) {
    if (std::find(plan.structures.begin(), plan.structures.end(), i) == plan.structures.end()) {
      plan.left_out.push_back({"structure \"" + scene.structures[i].name + "\"", "no mode reads it",
                               "decoding it, its bricks, and its distance in every sub-step"});
    }
  }
}

bool is_zero_everywhere(const Mode& mode) {
  return mode.strength_n.maximum() <= 0 ||
         std::any_of(mode.gates.begin(), mode.gates.end(), [](const Gate& gate) { return gate.factor.maximum() <= 0; });
}

/// Whether all constraints of the plan always form a configuration of section 3.1, which the analytical solver accepts:
/// at most one plane direction, lines all parallel to each other and, where there are planes, along their normal; all
/// at one place, unless there is only one.
bool is_always_analytical(const std::vector<Footprint>& footprints) {
  std::vector<Footprint> constraints;
  std::copy_if(footprints.begin(), footprints.end(), std::back_inserter(constraints),
               [](const Footprint& footprint) { return footprint.primitive != solver::PrimitiveType::directed_force; });
  if (constraints.size() <= 1) {
    return true;
  }
  const auto same_axis = [&constraints](solver::PrimitiveType type) {
    const Footprint* first = nullptr;
    for (const Footprint& footprint : constraints) {
      if (footprint.primitive == type) {
        if (first != nullptr && (first->axis != footprint.axis || first->structure != footprint.structure)) {
          return false;
        }
        first = &footprint;
      }
    }
    return true;
  };
  const auto has = [&constraints](solver::PrimitiveType type) {
    return std::any_of(constraints.begin(), constraints.end(),
                       [type](const Footprint& f) { return f.primitive == type; });
  };
  const bool co_located = std::all_of(constraints.begin(), constraints.end(),
                                      [](const Footprint& footprint) { return footprint.co_located; });
  if (!co_located || !same_axis(solver::PrimitiveType::plane) || !same_axis(solver::PrimitiveType::line)) {
    return false;
  }
  if (has(solver::PrimitiveType::plane) && has(solver::PrimitiveType::line)) {
    return std::all_of(constraints.begin(), constraints.end(), [](const Footprint& footprint) {
      return footprint.primitive == solver::PrimitiveType::point || footprint.axis == Axis::gradient;
    });
  }
  return true;
}

/// "1 plane and 1 point", of the constraints.
std::string count_in_words(const std::vector<Footprint>& footprints) {
  std::map<solver::PrimitiveType, int> counts;
  for (const Footprint& footprint : footprints) {
    ++counts[footprint.primitive];
  }
  std::string text;
  for (const auto& [type, count] : counts) {
    text += (text.empty() ? "" : " + ") + std::to_string(count) + " " + solver::name_of(type);
  }
  return text.empty() ? "no primitive" : text;
}

void choose_solvers(const Scene& scene, const std::vector<Footprint>& footprints, Plan& plan) {
  plan.solvers = scene.solvers;
  if (!is_always_analytical(footprints)) {
    return;
  }
  const std::string why = count_in_words(footprints) + ": always analytical (section 3.1)";
  bool is_solved = false;  // by one that is asked before
  for (const solver::SolverType* type : solver::solver_types()) {
    if (is_solved && scene.solvers.contains(*type)) {
      plan.left_out.push_back({std::string(type->name) + " solver", why,
                               std::string(type->make_scratch == nullptr ? "nothing:" : "its scratch memory;") +
                                   " it would not be called"});
      plan.left_out.back().solver = type;
      plan.solvers.set(*type, false);
    }
    is_solved = is_solved || (scene.solvers.contains(*type) && type->solves == solver::Solves::section_3_1);
  }
}

/// The mode in the form for the tick; its structures are added to `index`.
ActiveMode activate(const Scene& scene, const Mode& mode, std::size_t scene_index, const Footprint& footprint,
                    double mm_per_m, StructureIndex& index) {
  return {.type = find_mode_type(mode.type),
          .scene_index = scene_index,
          .co_located = footprint.co_located,
          .holds = footprint.primitive == solver::PrimitiveType::plane && footprint.co_located,
          .strength = Strength(mode, std::ref(index)),
          .side = mode.side,
          .direction_of = mode.direction_of,
          .structure = footprint.structure,
          .level_mm = mode.level_mm,
          .margin_mm = mode.margin_mm,
          .push_share = push_share(mode, scene.stiffness_n_per_m, mm_per_m),
          .shape = mode.shape,
          .position_mm = mode.position_mm,
          .direction = glm::normalize(mode.direction)};
}

/// Why a mode is not part of the plan; nothing for one that is. `missing`: what it reads and the scan does not have.
std::optional<LeftOut> why_left_out(const Mode& mode, std::size_t scene_index, io::FieldSet missing) {
  const std::string name = name_of(mode, scene_index);
  const ModeType& type = *find_mode_type(mode.type);
  if (!mode.enabled) return LeftOut{name, "it is switched off", saved_by(type), io::FieldSet::none, scene_index};
  if (is_zero_everywhere(mode)) {
    return LeftOut{name, "its strength is zero everywhere", saved_by(type), io::FieldSet::none, scene_index};
  }
  if (missing != io::FieldSet::none) {
    return LeftOut{name, "there is no " + words(missing) + " here",
                   "nothing that could be measured: it cannot be felt here"};
  }
  return std::nullopt;
}

void add(const ActiveMode& mode, io::FieldSet reads, Plan& plan) {
  plan.fields = plan.fields | reads;
  if (mode.holds && mode.structure >= 0) {
    plan.holds_structure[static_cast<std::size_t>(mode.structure)] = true;
  } else {
    plan.holds_iso_surface = plan.holds_iso_surface || mode.holds;
  }
  plan.modes.push_back(mode);
}

void leave_out_unread_fields(io::FieldSet available, Plan& plan) {
  for (const FieldName& entry : field_names) {
    if (entry.field == io::FieldSet::distance) continue;  // said of each structure
    if (contains(available, entry.field) && !contains(plan.fields, entry.field)) {
      plan.left_out.push_back({entry.name, "no mode reads it", entry.cost, entry.field});
    }
  }
}

}  // namespace

std::vector<std::string> names_of(io::FieldSet fields) {
  std::vector<std::string> names;
  for (const FieldName& entry : field_names) {
    if (contains(fields, entry.field)) {
      names.emplace_back(entry.name);
    }
  }
  return names;
}

Plan make_plan(const Scene& scene, io::FieldSet available, const Workspace& workspace) {
  validate(scene);
  Plan plan;
  plan.stiffness_n_per_m = scene.stiffness_n_per_m;
  plan.workspace = workspace;
  plan.subdivision = scene.subdivision;
  std::vector<Footprint> footprints;
  for (std::size_t i = 0; i < scene.modes.size(); ++i) {
    Mode mode = scene.modes[i];
    const ModeType& type = *find_mode_type(mode.type);
    add_boundary(scene, mode);
    // Before its structures are looked up: they do not count against the limit.
    if (auto left_out = why_left_out(mode, i, io::FieldSet::none)) {
      plan.left_out.push_back(std::move(*left_out));
      continue;
    }
    Footprint footprint = type.footprint(mode);
    const std::vector<std::size_t> structures_before = plan.structures;
    StructureIndex index(scene, plan.structures);
    if (!mode.structure.empty()) footprint.structure = static_cast<int>(index(mode.structure));
    const ActiveMode active = activate(scene, mode, i, footprint, workspace.mm_per_m, index);
    const io::FieldSet reads = type.reads(mode) | active.strength.reads();
    if (auto left_out = why_left_out(mode, i, without(reads, available))) {
      plan.left_out.push_back(std::move(*left_out));
      plan.structures = structures_before;
    } else {
      check_count(plan.structures);
      footprints.push_back(footprint);
      add(active, reads, plan);
    }
  }
  add_watched_structures(scene, plan);
  leave_out_unread_fields(available, plan);
  choose_solvers(scene, footprints, plan);
  return plan;
}

}  // namespace palpate::modes
