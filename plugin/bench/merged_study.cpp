#include "plugin/bench/merged_study.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "io/structures/edits.h"
#include "io/structures/outline_places.h"
#include "modes/scene/scene_json.h"
#include "plugin/bench/hand_trace.h"
#include "plugin/bench/traced_bodies.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

constexpr double ball_mm = 20, gap_mm = 3, socket_mm = 32;  // radii, about the origin; how wide
constexpr double tissue_hu = 60, gap_hu = -100;
constexpr double bridged_degrees = 35, judged_degrees = 30;  // off the way to the bridge

const glm::dvec3 bridge_way = glm::normalize(glm::dvec3(1, -0.4, 0.2));

double ball_and_socket(const glm::dvec3& at) {
  const double r = glm::length(at);
  return std::max(ball_mm - r, std::min(r - (ball_mm + gap_mm), socket_mm - r));
}

double degrees_off(const glm::dvec3& at) {
  return glm::degrees(std::acos(std::clamp(glm::dot(glm::normalize(at), bridge_way), -1.0, 1.0)));
}

double merged(const glm::dvec3& at) {
  const double r = glm::length(at);
  if (r < 1) return ball_and_socket(at);
  return std::max(ball_and_socket(at), std::min(socket_mm - r, r * glm::radians(bridged_degrees - degrees_off(at))));
}

/// Both are felt on the way into tissue, so that the gap holds the hand.
constexpr const char* edges_felt = R"({"version": 1, "modes": [{"type": "surface", "side": "entering",
  "strength_n": {"of": "value", "nodes": [[-24, 0], [-16, 1.5]]}}]})";

}  // namespace

MergedResult study_merged(int hands, bool felt) {
  const io::Geometry geometry = testdata::make_geometry({.size = glm::ivec3(72)});
  const testdata::Phantom phantom{.background = gap_hu,
                                  .bodies = {{testdata::Ball{{0, 0, 0}, socket_mm}, tissue_hu},
                                             {testdata::Ball{{0, 0, 0}, ball_mm + gap_mm}, gap_hu},
                                             {testdata::Ball{{0, 0, 0}, ball_mm}, tissue_hu}}};
  const auto scan = soft_scan(phantom, geometry);
  constexpr double reach_mm = 8;
  const auto truth = outline_of(geometry, ball_and_socket, reach_mm), outline = outline_of(geometry, merged, reach_mm);
  std::vector<glm::dvec3> judged;
  std::vector<EdgePlace> way;
  for (const io::OutlinePlace& place : io::outline_places(*truth, 1.5)) {
    const double r = glm::length(place.place_mm);
    if (r > ball_mm + 2 * gap_mm) continue;  // the socket's outside
    const glm::dvec3 outward = place.place_mm / r;
    if (degrees_off(place.place_mm) < judged_degrees) {
      judged.push_back((r < ball_mm + gap_mm / 2 ? ball_mm : ball_mm + gap_mm) * outward);
    }
    // A little farther than it is merged, as a hand would.
    if (r < ball_mm + gap_mm / 2 && degrees_off(place.place_mm) < bridged_degrees + 3) {
      way.push_back({(ball_mm + gap_mm / 2) * outward, outward});
    }
  }
  sort_for_hand(way, glm::dvec3(0));
  modes::Scene scene = modes::scene_from_json(felt ? edges_felt : R"({"version": 1, "modes": []})", "merged study");
  scene.workspace.center_mm = glm::dvec3(0);
  MergedResult result;
  const auto distances = [&](const io::DistanceField& field, std::vector<double>& into) {
    for (const glm::dvec3& at : judged) into.push_back(std::abs(field.sample(at).mm));
  };
  for (int hand = 0; hand < hands; ++hand) {
    // Nothing is pressed: the edges on both sides hold the hand.
    const HandTrace trace = trace_by_hand(way, scan, scene, false, static_cast<unsigned>(hand + 1));
    const auto cut = io::apply_edit(outline, io::RemoveEdit{{.path_mm = trace.points_mm, .radius_mm = gap_mm / 2}});
    distances(*outline, result.before_mm);
    distances(*cut, result.after_mm);
    result.path_mm += trace.path_mm / hands;
    result.points += static_cast<double>(trace.points_mm.size()) / hands;
  }
  return result;
}

}  // namespace palpate::plugin
