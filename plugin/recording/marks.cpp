#include "plugin/recording/marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "modes/tick/haptic_step.h"

namespace palpate::plugin {
namespace {

constexpr double still_mm = 2;        // a hand that presses a button moves so far
constexpr double path_step_mm = 0.2;  // shorter steps are tremor, and would add to a path's length

std::string boundary_of(const RecordedSession& session, std::size_t n) {
  const modes::Scene& scene = session.scene(n);
  double strongest = 0;
  std::string name;
  for (const PrimitiveRecord& share : session.shares(n)) {
    const glm::dvec3 force(share.force_n[0], share.force_n[1], share.force_n[2]);
    const bool is_of_scene = share.mode < scene.modes.size();  // else of the scene that is being left
    if (!is_of_scene || glm::length(force) <= strongest) continue;
    strongest = glm::length(force);
    const modes::Mode& mode = scene.modes[share.mode];
    name = mode.name.empty() ? mode.type : mode.name;
  }
  return name;
}

FeltMark mark_at(const RecordedSession& session, std::size_t n, std::size_t number) {
  return {.name = fmt::format("FeltMark {}", number),
          .tick = session.frame(n).index,
          .time_s = session.time_s(n),
          .position_mm = session.proxy_mm(n),
          .boundary = boundary_of(session, n),
          .value = session.frame(n).value,
          .force_n = glm::length(session.sent_n(n))};
}

MarkedPath path_between(const RecordedSession& session, std::size_t first, std::size_t end, std::size_t number) {
  MarkedPath path{.name = fmt::format("Path {}", number),
                  .begin_s = session.time_s(first),
                  .end_s = session.time_s(end - 1),
                  .points_mm = {session.proxy_mm(first)}};
  for (std::size_t n = first + 1; n < end; ++n) {
    const glm::dvec3 at = session.proxy_mm(n);
    const double step = glm::distance(at, path.points_mm.back());
    if (step < path_step_mm && n + 1 < end) continue;
    path.length_mm += step;
    path.points_mm.push_back(at);
  }
  return path;
}

bool stays(const RecordedSession& session, std::size_t first, std::size_t end) {
  const glm::dvec3 begin = session.proxy_mm(first);
  for (std::size_t n = first; n < end; ++n) {
    if (glm::distance(session.proxy_mm(n), begin) > still_mm) return false;
  }
  return true;
}

void measure(Marks& marks) {
  const std::vector<FeltMark>& points = marks.points;
  for (std::size_t n = 1; n < points.size(); ++n) {
    marks.distances.push_back({n - 1, n, glm::distance(points[n - 1].position_mm, points[n].position_mm)});
  }
  for (std::size_t n = 1; n + 1 < points.size(); ++n) {
    const glm::dvec3 before = points[n - 1].position_mm - points[n].position_mm;
    const glm::dvec3 after = points[n + 1].position_mm - points[n].position_mm;
    const double lengths = glm::length(before) * glm::length(after);
    if (lengths == 0) continue;  // two marks at one place have no angle
    marks.angles.push_back({n, glm::degrees(std::acos(std::clamp(glm::dot(before, after) / lengths, -1.0, 1.0)))});
  }
}

}  // namespace

Marks marks_of(const RecordedSession& session) {
  Marks marks;
  const auto is_down = [&](std::size_t n) { return (session.frame(n).buttons & mark_button) != 0; };
  for (std::size_t n = 0; n < session.size(); ++n) {
    if (!is_down(n)) continue;
    std::size_t end = n;
    while (end < session.size() && is_down(end)) ++end;
    if (stays(session, n, end)) {
      marks.points.push_back(mark_at(session, n, marks.points.size() + 1));
    } else {
      marks.paths.push_back(path_between(session, n, end, marks.paths.size() + 1));
    }
    n = end;
  }
  measure(marks);
  return marks;
}

}  // namespace palpate::plugin
