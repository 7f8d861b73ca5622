#include "modes/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <set>
#include <stdexcept>

#include "modes/scene/number_text.h"
#include "modes/scene/refuse.h"
#include "modes/types/mode_type.h"

namespace palpate::modes {
namespace {

void check_positive(const std::string& path, double value, const std::string& unit) {
  if (!(value > 0) || !std::isfinite(value)) {
    refuse(path, say("not-a-number-above-0", number_text(value), unit));
  }
}

void check_finite(const std::string& path, const Vec3& vector) {
  if (!std::isfinite(vector.x) || !std::isfinite(vector.y) || !std::isfinite(vector.z)) {
    refuse(path, say("not-finite"));
  }
}

void check_color(const std::string& path, const std::string& color) {
  const bool hexadecimal =
      color.size() == 7 && color[0] == '#' && color.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!color.empty() && !hexadecimal) {
    refuse(path, say("not-a-color-such-as-0072b2", color));
  }
}

void check_function(const std::string& path, const TransferFunction& function, const std::string& what) {
  if (function.nodes().empty()) {
    refuse(path, say("missing-strength", what));
  }
  for (std::size_t i = 0; i < function.nodes().size(); ++i) {
    const double value = function.nodes()[i].value;
    if (value < 0) {
      const std::string node = function.nodes().size() == 1 ? "" : ".nodes[" + std::to_string(i) + "][1]";
      refuse(path + node, say("negative-value", number_text(value), what));
    }
  }
}

void check_rotation(const std::string& path, const glm::dmat3& rotation) {
  const glm::dmat3 product = glm::transpose(rotation) * rotation;
  double worst = 0;
  for (int i = 0; i < 3; ++i) {
    check_finite(path, rotation[i]);
    for (int j = 0; j < 3; ++j) {
      worst = std::max(worst, std::abs(product[i][j] - (i == j ? 1.0 : 0.0)));
    }
  }
  // A similarity has to turn unit directions into unit directions; what is looser than this was not meant as a
  // rotation.
  if (worst > 1e-9) {
    refuse(path, say("axes-are-not-of-unit-length"));
  }
  if (glm::determinant(rotation) < 0) {
    refuse(path, say("mirror-image"));
  }
}

void check_workspace(const WorkspaceSettings& workspace) {
  if (workspace.center_mm) {
    check_finite("workspace.center_mm", *workspace.center_mm);
  }
  check_rotation("workspace.rotation", workspace.rotation);
  check_positive("workspace.scale", workspace.scale, "mm of patient for one mm of hand");
}

void check_tissue(const std::string& path, const Tissue& tissue) {
  if (tissue.name.empty()) {
    refuse(path + ".name", say("is-missing"));
  }
  if (std::isnan(tissue.low) || std::isnan(tissue.high) || !(tissue.low < tissue.high)) {
    refuse(path + ".low", say("low-not-below-high"));
  }
  if (!(tissue.softness > 0) || !(tissue.softness <= tissue.high - tissue.low)) {
    refuse(path + ".softness", say("not-above-0-and-at-most", number_text(tissue.softness)));
  }
  check_color(path + ".color", tissue.color);
}

void check_boundary(const std::string& path, const Mode& mode, const Scene& scene) {
  if (mode.from.empty() && mode.to.empty()) {
    return;
  }
  for (const auto& [key, name] : {std::pair{".from", mode.from}, std::pair{".to", mode.to}}) {
    const auto named = [&name = name](const Tissue& tissue) { return tissue.name == name; };
    if (std::none_of(scene.tissues.begin(), scene.tissues.end(), named)) {
      refuse(path + key, say("there-is-no-tissue-in-tissues", name));
    }
  }
  if (mode.from == mode.to) {
    refuse(path + ".to", say("boundary-lies-between-two-different-tissues"));
  }
}

void check_structure_of(const std::string& path, const std::string& name, const Scene& scene) {
  const auto named = [&name](const SceneStructure& structure) { return structure.name == name; };
  if (std::none_of(scene.structures.begin(), scene.structures.end(), named)) {
    refuse(path, say("there-is-no-structure", name));
  }
}

/// Where a datum is a distance it is that of a structure, and else of none.
void check_datum(const std::string& path, Datum of, const std::string& structure, const Scene& scene) {
  if (of == Datum::distance) {
    check_structure_of(path + ".structure", structure, scene);
  }
}

void check_structure(const std::string& path, const SceneStructure& structure) {
  if (structure.name.empty()) {
    refuse(path + ".name", say("is-missing"));
  }
  if (!is_drawn(structure)) {
    if (structure.file.empty()) {
      refuse(path + ".file", say("is-missing"));
    }
    if (structure.segment.empty() && !structure.segment_number) {
      refuse(path + ".segment", say("is-missing"));
    }
  } else if (!structure.segment.empty() || structure.segment_number) {
    refuse(path + ".segment", say("drawn-structure-has-no-segment"));
  }
  if (structure.margin_mm) {
    check_positive(path + ".margin_mm", *structure.margin_mm, "mm");
  }
  check_color(path + ".color", structure.color);
}

void check_mode(const std::string& path, const Mode& mode, const Scene& scene) {
  const ModeType* type = find_mode_type(mode.type);
  if (type == nullptr) {
    refuse(path + ".type", say("there-is-no-mode", mode.type, mode_type_names()));
  }
  check_function(path + ".strength_n", mode.strength_n, "a strength is in newtons");
  for (std::size_t i = 0; i < mode.gates.size(); ++i) {
    const std::string gate = path + ".gates[" + std::to_string(i) + "]";
    check_function(gate + ".factor", mode.gates[i].factor, "a gate is a factor");
    check_datum(gate, mode.gates[i].of, mode.gates[i].structure, scene);
  }
  check_datum(path + ".strength_n", mode.strength_of, mode.strength_structure, scene);
  if (!mode.structure.empty() || contains(type->keys, Key::margin)) {
    check_structure_of(path + ".structure", mode.structure, scene);
  }
  check_finite(path + ".level_mm", Vec3(mode.level_mm));
  check_positive(path + ".margin_mm", mode.margin_mm, "mm");
  check_boundary(path, mode, scene);
  check_finite(path + ".position_mm", mode.position_mm);
  check_finite(path + ".direction", mode.direction);
  if (!(glm::length(mode.direction) > 1e-100)) {
    refuse(path + ".direction", say("no-length"));
  }
  check_color(path + ".color", mode.color);
}

template <typename Items>
void check_unique_names(const std::string& list, const Items& items) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!items[i].name.empty() && !names.insert(items[i].name).second) {
      refuse(list + "[" + std::to_string(i) + "].name", say("used-twice", items[i].name));
    }
  }
}

}  // namespace

bool is_drawn(const SceneStructure& structure) noexcept {
  return structure.file.empty() && !structure.edits.empty() &&
         std::holds_alternative<io::ContoursEdit>(structure.edits.front());
}

void validate(const Scene& scene) {
  check_positive("stiffness_n_per_m", scene.stiffness_n_per_m, "newtons per meter");
  check_positive("limits.force_limit_n", scene.limits.force_n, "newtons");
  check_positive("limits.slew_limit_n_per_ms", scene.limits.slew_n_per_ms, "newtons per millisecond");
  check_positive("limits.ramp_s", scene.limits.ramp_s, "seconds");
  check_positive("limits.speed_limit_m_per_s", scene.limits.speed_m_per_s, "meters per second");
  check_workspace(scene.workspace);
  if (scene.solvers.is_empty()) {
    refuse("solvers", say("all-are-switched-off"));
  }
  check_positive("subdivision.step_mm", scene.subdivision.step_mm, "mm of patient");
  check_positive("subdivision.proxy_step_mm", scene.subdivision.proxy_step_mm, "mm of patient");
  if (scene.subdivision.most_halts < 0 || scene.subdivision.most_halts > 1000) {
    refuse("subdivision.most_halts", say("not-between-0-and-1000", scene.subdivision.most_halts));
  }
  if (scene.subdivision.most < 1 || scene.subdivision.most > 1000) {
    refuse("subdivision.most", say("not-between-1-and-1000", scene.subdivision.most));
  }
  try {
    io::validate(scene.filter);
  } catch (const InvalidInput& error) {
    throw InvalidInput(at_place("filter.", error.text(), ""));
  }
  if (scene.gradient_scale_mm) {
    check_positive("gradient_scale_mm", *scene.gradient_scale_mm, "mm");
  }
  for (std::size_t i = 0; i < scene.tissues.size(); ++i) {
    check_tissue("tissues[" + std::to_string(i) + "]", scene.tissues[i]);
  }
  if (scene.modes.size() > Scene::most_modes) {
    refuse("modes", say("too-many", scene.modes.size(), Scene::most_modes));
  }
  for (std::size_t i = 0; i < scene.modes.size(); ++i) {
    check_mode("modes[" + std::to_string(i) + "]", scene.modes[i], scene);
  }
  for (std::size_t i = 0; i < scene.structures.size(); ++i) {
    check_structure("structures[" + std::to_string(i) + "]", scene.structures[i]);
  }
  check_unique_names("tissues", scene.tissues);
  check_unique_names("structures", scene.structures);
  check_unique_names("modes", scene.modes);
}

io::FieldOptions field_options(const Sampling& sampling) {
  io::FieldOptions options;
  options.value = sampling.value;
  options.gradient = sampling.gradient;
  return options;
}

Workspace place_workspace(const WorkspaceSettings& settings, const Vec3& box_low_mm, const Vec3& box_high_mm,
                          const Vec3& half_extent_m) {
  Workspace workspace;
  workspace.rotation = settings.rotation;
  workspace.center_mm = settings.center_mm.value_or(0.5 * (box_low_mm + box_high_mm));
  workspace.mm_per_m = 1000.0 * settings.scale;
  if (settings.fit) {
    // Per device axis, the box's half-extent as seen along it, measured from the center that was chosen.
    double mm_per_m = 0;
    for (int axis = 0; axis < 3; ++axis) {
      double reach_mm = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 point{(corner & 1) != 0 ? box_high_mm.x : box_low_mm.x,
                         (corner & 2) != 0 ? box_high_mm.y : box_low_mm.y,
                         (corner & 4) != 0 ? box_high_mm.z : box_low_mm.z};
        reach_mm = std::max(reach_mm, std::abs(glm::dot(settings.rotation[axis], point - workspace.center_mm)));
      }
      mm_per_m = std::max(mm_per_m, reach_mm / half_extent_m[axis]);
    }
    if (!(mm_per_m > 0) || !std::isfinite(mm_per_m)) {
      throw InvalidInput(say("workspace-fit-the-scan-or-the-device"));
    }
    workspace.mm_per_m = mm_per_m;
  }
  return workspace;
}

}  // namespace palpate::modes
