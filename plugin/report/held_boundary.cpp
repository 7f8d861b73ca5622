#include "plugin/report/held_boundary.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "io/fields/filtered.h"
#include "modes/scene/boundary_names.h"
#include "plugin/report/summary.h"
#include "plugin/session/strength_ahead.h"
#include "plugin/session/stroke.h"

namespace palpate::plugin {
namespace {

constexpr double felt_n = 0.05;  // below, a boundary is not said to be felt

bool is_surface(const modes::Plan& plan, std::size_t mode) {
  return std::any_of(plan.modes.begin(), plan.modes.end(),
                     [&](const modes::ActiveMode& active) { return active.scene_index == mode && active.holds; });
}

/// The edge of a structure is the structure's wherever it lies.
std::string name_at_site(std::size_t mode, const PreparedScene& felt, const modes::Scene& scene,
                         const glm::dvec3& place_mm, const modes::SiteMap* sites) {
  std::string name = display_name(scene, mode);
  if (sites == nullptr || !felt.volume || !sites->is_of(io::raw_of(felt.volume))) return name;
  if (!scene.modes[mode].structure.empty()) return name;
  const io::Sample sample = felt.source->sample(place_mm, felt.source->available() & io::FieldSet::gradient);
  return modes::name_at(name, sites->at(place_mm, sample.gradient));
}

}  // namespace

std::optional<std::size_t> holding_surface(std::span<const PrimitiveRecord> shares, const modes::Plan& plan) {
  std::optional<std::size_t> most;
  double largest = felt_n;
  for (const PrimitiveRecord& share : shares) {
    const double force = glm::length(vector_of(share.force_n));
    if (force > largest && is_surface(plan, share.mode)) {
      largest = force;
      most = share.mode;
    }
  }
  return most;
}

std::optional<double> known_to_mm(const PreparedScene& felt, const modes::Scene& scene, std::size_t mode,
                                  const glm::dvec3& place_mm) {
  if (mode >= scene.modes.size() || !scene.modes[mode].structure.empty()) return std::nullopt;
  return known_to_mm(*felt.source, felt.volume->geometry, scene, place_mm);
}

std::function<double(const TickRecord&, std::span<const PrimitiveRecord>)> known_to_of_ticks(
    const PreparedScene& felt, const modes::Scene& scene) {
  struct Last {
    glm::dvec3 place_mm{std::numeric_limits<double>::infinity()};
    std::size_t mode = 0;
    double known_to_mm = std::numeric_limits<double>::quiet_NaN();
  };
  return [felt, scene, last = Last()](const TickRecord& tick, std::span<const PrimitiveRecord> shares) mutable {
    constexpr double same_place_mm = 0.02, none = std::numeric_limits<double>::quiet_NaN();
    const auto mode = tick.change_part < 1 ? std::nullopt : holding_surface(shares, *felt.plan);
    if (!mode) return none;
    const glm::dvec3 place = felt.plan->workspace.to_patient(vector_of(tick.proxy_m));
    if (last.mode != *mode || !(glm::distance(last.place_mm, place) < same_place_mm)) {
      last = {place, *mode, known_to_mm(felt, scene, *mode, place).value_or(none)};
    }
    return last.known_to_mm;
  };
}

std::optional<HeldBoundary> held_boundary(std::span<const PrimitiveRecord> shares, const PreparedScene& felt,
                                          const modes::Scene& scene, const glm::dvec3& proxy_mm,
                                          const glm::dvec3& probe_mm, const modes::SiteMap* sites) {
  const auto mode = felt.plan ? holding_surface(shares, *felt.plan) : std::nullopt;
  if (!mode) return std::nullopt;
  HeldBoundary held{.mode = *mode, .name = name_at_site(*mode, felt, scene, proxy_mm, sites)};
  for (const modes::ActiveMode& active : felt.plan->modes) {
    if (active.scene_index != *mode) continue;
    held.full_strength_n = active.strength.most_n();
    // The proxy rests where the rising strength equals the force: the boundary's largest strength is farther in.
    const double pressed_mm = glm::distance(proxy_mm, probe_mm);
    const glm::dvec3 inward = pressed_mm > 0 ? (probe_mm - proxy_mm) / pressed_mm : glm::dvec3(0);
    held.strength_n = strength_ahead_n(active, *felt.plan, *felt.source, proxy_mm, inward);
  }
  held.known_to_mm = known_to_mm(felt, scene, *mode, proxy_mm);
  return held;
}

std::string in_words(const HeldBoundary& held) {
  return held.name + (held.known_to_mm ? fmt::format(", known to \u00b1{:.2g} mm", *held.known_to_mm) : "") +
         strength_to_text(held.strength_n, held.full_strength_n);
}

}  // namespace palpate::plugin
