#include "plugin/session/press_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "device/simulated/simulated_hand.h"
#include "plugin/messages/messages.h"
#include "plugin/session/stroke.h"

namespace palpate::plugin {
namespace {

constexpr double stroke_speed = 50;    // mm/s, when feeling the way
constexpr double threshold = 0.05;     // N: below, nothing is felt
constexpr double approach = 8;         // mm in front of the first boundary
constexpr double slide = 12;           // mm along the first boundary
constexpr double beyond = 2;           // mm past the last boundary's contact
constexpr double share_pressed = 0.6;  // of the first boundary's peak force, while sliding

/// A direction across the stroke that stays in an axial slice where it can: the patient's left to right.
glm::dvec3 across(const glm::dvec3& inward) {
  const glm::dvec3 left{1, 0, 0};
  const glm::dvec3 up{0, 0, 1};
  const glm::dvec3 side = std::abs(glm::dot(inward, left)) < 0.9 ? left : up;
  return glm::normalize(side - glm::dot(side, inward) * inward);
}

/// A stroke, and the surfaces met along it.
struct Met {
  std::vector<StrokePoint> stroke;
  std::vector<Contact> contacts;
};

Met feel(const modes::Plan& plan, const io::FieldSource& source, const glm::dvec3& from, const glm::dvec3& to) {
  Met met{.stroke = run_stroke(plan, source, from, to, stroke_speed), .contacts = {}};
  met.contacts = contacts_of(met.stroke, plan, threshold);
  return met;
}

}  // namespace

PressPath make_press_path(const modes::Plan& plan, const io::FieldSource& source, const glm::dvec3& from_mm,
                          const glm::dvec3& to_mm) {
  const Met met = feel(plan, source, from_mm, to_mm);
  if (met.contacts.empty()) {
    throw Refusal(say("scene-lets-nothing-be-felt-between",
                      fmt::format("{:.1f}, {:.1f}, {:.1f}", from_mm.x, from_mm.y, from_mm.z),
                      fmt::format("{:.1f}, {:.1f}, {:.1f}", to_mm.x, to_mm.y, to_mm.z)));
  }
  PressPath path;
  path.inward = glm::normalize(to_mm - from_mm);
  const Contact& first = met.contacts.front();
  path.contact_mm = met.stroke[first.first].position_mm;
  for (const Contact& contact : met.contacts) {
    if (std::find(path.boundaries.begin(), path.boundaries.end(), contact.boundary) == path.boundaries.end()) {
      path.boundaries.push_back(contact.boundary);
    }
  }

  // The hand is a spring in front of the coupling's: to press with a force it aims deeper than the probe gets. Both are
  // of the hand's meters; the script is of the patient's millimeters.
  const double hand_mm_per_n = plan.workspace.mm_per_m / device::HandModel{}.stiffness;
  const double coupling_mm_per_n = plan.workspace.mm_per_m / plan.stiffness_n_per_m;
  const double press = share_pressed * first.peak_n * (hand_mm_per_n + coupling_mm_per_n);
  const auto target = [&](double depth_mm, double aside_mm) {
    return path.contact_mm + depth_mm * path.inward + aside_mm * across(path.inward);
  };
  // The slide follows the boundary: felt for again at its far end.
  const glm::dvec3 aside = slide * across(path.inward);
  const Met far_end = feel(plan, source, from_mm + aside, to_mm + aside);
  const double far_depth =
      far_end.contacts.empty()
          ? 0
          : glm::dot(far_end.stroke[far_end.contacts.front().first].position_mm - path.contact_mm, path.inward);
  const auto boundary_depth = [&](const Contact& contact) {
    return glm::dot(met.stroke[contact.first].position_mm - path.contact_mm, path.inward);
  };
  const Contact& last = met.contacts.back();
  const double full = boundary_depth(last) + beyond + last.peak_n * hand_mm_per_n;

  path.hand = {{0.0, target(-approach, 0)},
               {1.0, target(-approach, 0)},
               {2.0, target(press, 0)},
               {3.0, target(press, 0)},
               {4.5, target(far_depth + press, slide)},
               {6.0, target(press, 0)},
               {6.5, target(press, 0)},
               {9.0, target(full, 0)},
               {10.0, target(full, 0)},
               {11.5, target(-approach, 0)},
               {12.0, target(-approach, 0)}};
  return path;
}

}  // namespace palpate::plugin
