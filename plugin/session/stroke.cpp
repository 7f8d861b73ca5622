#include "plugin/session/stroke.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <stdexcept>

#include "modes/tick/haptic_step.h"
#include "plugin/messages/messages.h"
#include "plugin/session/strength_ahead.h"
#include "solver/chain.h"

namespace palpate::plugin {
namespace {

constexpr double ticks_per_s = 1000;
constexpr double most_ticks = 1e7;

/// The primitive that pushes most, if any does.
std::optional<std::size_t> pushes_most(const modes::StepResult& result) {
  std::optional<std::size_t> most;
  double largest = 0;
  for (std::size_t n = 0; n < result.shares.size(); ++n) {
    const double force = glm::length(result.shares[n]);
    if (force > largest) {
      largest = force;
      most = n;
    }
  }
  return most;
}

double value_at(const io::FieldSource& source, const glm::dvec3& place) {
  const io::Sample sample = source.sample(place, io::FieldSet::value);
  return sample.inside ? sample.value : std::numeric_limits<double>::quiet_NaN();
}

std::array<double, io::most_structures> distances_at(const modes::Plan& plan, const io::FieldSource& source,
                                                     const glm::dvec3& place) {
  std::array<double, io::most_structures> distances{};
  if (!plan.structures.empty()) {
    const io::Sample sample = source.sample(place, io::FieldSet::distance);
    for (std::size_t n = 0; n < plan.structures.size(); ++n) distances[n] = sample.distance[n].mm;
  }
  return distances;
}

}  // namespace

std::vector<StrokePoint> run_stroke(const modes::Plan& plan, const io::FieldSource& source, const glm::dvec3& from_mm,
                                    const glm::dvec3& to_mm, double speed_mm_per_s, StrokeDetail detail) {
  const double length = glm::distance(from_mm, to_mm);
  const double count = std::ceil(length / speed_mm_per_s * ticks_per_s);
  if (!(count >= 1) || count > most_ticks) {
    throw Refusal(say("stroke-has-no-ticks", fmt::format("{}", length), fmt::format("{}", speed_mm_per_s),
                      fmt::format("{}", count), fmt::format("{:.0f}", most_ticks)));
  }
  std::vector<StrokePoint> stroke;
  stroke.reserve(static_cast<std::size_t>(count) + 1);
  solver::Chain chain({.solvers = plan.solvers});
  const auto scratch = std::make_unique<modes::StepScratch>();
  modes::Touch touch;
  for (double n = 0; n <= count; ++n) {
    const glm::dvec3 position = from_mm + (n / count) * (to_mm - from_mm);
    const modes::StepResult result =
        modes::step(plan, source, plan.workspace.to_device(position), touch, chain, *scratch);
    if (result.outcome == solver::Outcome::refused || result.outcome == solver::Outcome::unsuitable) {
      throw Refusal(
          say("balance-not-solved", fmt::format("{:.3f}, {:.3f}, {:.3f}", position.x, position.y, position.z)));
    }
    const glm::dvec3 proxy = plan.workspace.to_patient(result.proxy_m);
    const std::optional<std::size_t> most = pushes_most(result);
    stroke.push_back({.position_mm = position,
                      .proxy_mm = proxy,
                      .force_n = plan.workspace.direction_to_patient(result.force_n),
                      .solver = result.solver,
                      .error_bound_m = result.error_bound,
                      .boundary = most ? std::optional<std::size_t>(result.mode_of[*most]) : std::nullopt,
                      .primitive = most ? std::optional(result.primitives[*most].type) : std::nullopt});
    if (detail == StrokeDetail::forces_alone) continue;
    stroke.back().value = value_at(source, proxy);
    stroke.back().distance_mm = distances_at(plan, source, proxy);
    stroke.back().value_passed = value_at(source, position);
  }
  return stroke;
}

std::vector<Contact> contacts_of(std::span<const StrokePoint> stroke, const modes::Plan& plan, double threshold_n) {
  std::vector<Contact> contacts;
  const auto is_surface = [&](std::size_t scene_index) {
    for (const modes::ActiveMode& mode : plan.modes) {
      if (mode.scene_index == scene_index) {
        return mode.holds;
      }
    }
    return false;
  };
  bool held = false;
  for (std::size_t n = 0; n < stroke.size(); ++n) {
    const StrokePoint& point = stroke[n];
    const double force = glm::length(point.force_n);
    const bool now = point.boundary && force > threshold_n && is_surface(*point.boundary);
    if (now && (!held || contacts.back().boundary != *point.boundary)) {
      contacts.push_back({.boundary = *point.boundary, .first = n, .last = n, .peak_n = force});
    } else if (now) {
      contacts.back().last = n;
      contacts.back().peak_n = std::max(contacts.back().peak_n, force);
    }
    held = now;
  }
  return contacts;
}

void add_strengths(std::span<Contact> contacts, std::span<const StrokePoint> stroke, const modes::Plan& plan,
                   const io::FieldSource& source) {
  if (stroke.empty()) return;
  const glm::dvec3 inward = glm::normalize(stroke.back().position_mm - stroke.front().position_mm);
  for (Contact& contact : contacts) {
    for (const modes::ActiveMode& mode : plan.modes) {
      if (mode.scene_index != contact.boundary) continue;
      contact.full_strength_n = mode.strength.most_n();
      // A stroke may end before the boundary gives all that it can.
      contact.strength_n = strength_ahead_n(mode, plan, source, stroke[contact.last].proxy_mm, inward);
      for (std::size_t n = contact.first; n <= contact.last; ++n) {
        const io::Sample sample = source.sample(stroke[n].proxy_mm, plan.fields);
        contact.strength_n = std::max(contact.strength_n, strength_against_n(mode, sample, inward));
      }
    }
  }
}

std::string strength_to_text(const Contact& contact) {
  return strength_to_text(contact.strength_n, contact.full_strength_n);
}

std::string strength_to_text(double strength_n, double full_strength_n) {
  constexpr double noticeably = 0.75;
  const double part = full_strength_n > 0 ? strength_n / full_strength_n : 1;
  return part > 0.01 && part < noticeably
             ? fmt::format("; {:.2f} of its {:.2g} N: thin or faint there", part, full_strength_n)
             : "";
}

}  // namespace palpate::plugin
