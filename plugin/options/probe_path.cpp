#include "plugin/options/probe_path.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <vector>

#include "device/simulated/simulated_stylus.h"
#include "io/bounding_box.h"
#include "plugin/app/errors.h"
#include "plugin/app/vector_text.h"
#include "plugin/messages/messages.h"
#include "plugin/report/summary.h"
#include "plugin/session/press_path.h"

namespace palpate::plugin {
namespace {

std::vector<PathPoint> path_for(const ProbePathOption& option, const PreparedScene& felt, const io::Box& box) {
  if (!option.file.empty()) {
    return read_path_csv(option.file);
  }
  // From the front towards the middle, at three quarters of the scan's height: on a head, the forehead.
  const glm::dvec3 middle{0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y),
                          box.low.z + 0.75 * (box.high.z - box.low.z)};
  const glm::dvec3 from =
      option.from.empty() ? glm::dvec3(middle.x, box.low.y, middle.z) : parse_vector(option.from, "--from");
  const glm::dvec3 to = option.to.empty() ? middle : parse_vector(option.to, "--to");
  return make_press_path(*felt.plan, *felt.source, from, to).hand;
}

glm::dvec3 middle_of(const std::vector<PathPoint>& path) {
  glm::dvec3 low = path.front().position_mm;
  glm::dvec3 high = low;
  for (const PathPoint& point : path) {
    low = glm::min(low, point.position_mm);
    high = glm::max(high, point.position_mm);
  }
  return 0.5 * (low + high);
}

std::vector<device::Waypoint> to_device(const std::vector<PathPoint>& path, const modes::Workspace& workspace,
                                        const glm::dvec3& half_extent_m) {
  std::vector<device::Waypoint> waypoints;
  for (const PathPoint& point : path) {
    const glm::dvec3 at = workspace.to_device(point.position_mm);
    if (glm::any(glm::greaterThan(glm::abs(at), half_extent_m))) {
      throw InputRefused(say("path-point-at-s", fmt::format("{}", point.time_s), patient_coordinates(point.position_mm),
                             fmt::format("{:.0f}", 1e3 * glm::length(at))));
    }
    waypoints.push_back({.time = point.time_s, .position = at, .buttons = point.buttons});
  }
  return waypoints;
}

}  // namespace

void add_probe_path_option(CLI::App& command, ProbePathOption& option) {
  command
      .add_option("--path", option.file,
                  "the path of a simulated hand: a CSV file: time_s,x_mm,y_mm,z_mm (LPS) and, optionally, buttons")
      ->check(CLI::ExistingFile);
  command.add_option(
      "--from", option.from,
      "where the simulated hand begins to press: x,y,z in mm (default: the front, at 3/4 of the scan's height)");
  command.add_option("--to", option.to, "where it presses to (default: the middle, at the same height)");
}

double follow_probe_path(const ProbePathOption& option, const io::Volume& volume, modes::Scene& scene,
                         PreparedScene& felt, device::SimulatedStylus& stylus) {
  const glm::dvec3 half_extent_m = stylus.specification().workspace_half_extent;
  const std::vector<PathPoint> path = path_for(option, felt, bounding_box(volume.geometry));
  if (!scene.workspace.center_mm) {
    // The hand's middle is where the path is; the fields do not depend on it.
    scene.workspace.center_mm = middle_of(path);
    felt.plan = plan_for(scene, volume, half_extent_m);
  }
  stylus.follow(to_device(path, felt.plan->workspace, half_extent_m));
  return path.back().time_s;
}

}  // namespace palpate::plugin
