#include "plugin/recording/marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <utility>

#include "modes/tick/haptic_step.h"
#include "modes/types/mode_type.h"
#include "plugin/recording/recorded_session.h"

namespace palpate::plugin {
namespace {

constexpr double still_mm = 2;        // a hand moves up to this distance while it presses a button
constexpr double path_step_mm = 0.2;  // shorter steps are tremor, and would add to a path's length

constexpr double tap_s = 0.25;   // a shorter press is a tap, too short to draw a path
constexpr double held_n = 0.05;  // below this, a boundary counts as not felt

bool is_boundary(const modes::Mode& mode) {
  using modes::Key;
  return modes::reads_key(mode, Key::side) || modes::reads_key(mode, Key::margin) ||
         modes::reads_key(mode, Key::landmark);
}

std::string boundary_of(const MarkPresses::Moment& moment) {
  double strongest = held_n;
  std::string name;
  for (const PrimitiveRecord& share : moment.shares) {
    const glm::dvec3 force(share.force_n[0], share.force_n[1], share.force_n[2]);
    const bool is_of_scene = share.mode < moment.scene.modes.size();  // else it belongs to the previous scene
    if (!is_of_scene || glm::length(force) <= strongest) continue;
    const modes::Mode& mode = moment.scene.modes[share.mode];
    if (!is_boundary(mode)) continue;
    strongest = glm::length(force);
    name = mode.name.empty() ? mode.type : mode.name;
  }
  return name;
}

void step(MarkedPath& path, const glm::dvec3& to, bool touched) {
  const double mm = glm::distance(path.points_mm.back(), to);
  path.length_mm += mm;
  if (touched) path.touched_mm += mm;
  path.points_mm.push_back(to);
}

template <typename Named>
std::string free_name(const char* kind, const std::vector<Named>& others) {
  for (std::size_t number = 1;; ++number) {
    std::string name = fmt::format("{} {}", kind, number);
    if (std::ranges::none_of(others, [&](const Named& other) { return other.name == name; })) return name;
  }
}

}  // namespace

std::optional<MarkMade> MarkPresses::take(const Moment& moment) {
  if ((moment.tick.buttons & mark_button) == 0) return finish();
  const glm::dvec3& at = moment.proxy_mm;
  if (!std::exchange(down_, true)) {
    mark_ = {.tick = moment.tick.index,
             .time_s = moment.time_s,
             .position_mm = at,
             .boundary = boundary_of(moment),
             .value = moment.tick.value,
             .force_n = glm::length(glm::dvec3(moment.tick.sent_n[0], moment.tick.sent_n[1], moment.tick.sent_n[2]))};
    path_ = {.begin_s = moment.time_s, .points_mm = {at}};
    moved_ = false;
  }
  moved_ = moved_ || glm::distance(at, mark_.position_mm) > still_mm;
  touches_ = !boundary_of(moment).empty();
  if (glm::distance(at, path_.points_mm.back()) >= path_step_mm) step(path_, at, touches_);
  path_.end_s = moment.time_s;
  last_mm_ = at;
  return std::nullopt;
}

std::optional<MarkMade> MarkPresses::finish() {
  if (!std::exchange(down_, false)) return std::nullopt;
  if (!moved_ || path_.end_s - path_.begin_s < tap_s) return std::move(mark_);
  if (path_.points_mm.back() != last_mm_) step(path_, last_mm_, touches_);
  return std::move(path_);
}

PathContact contact_of(const MarkedPath& path) {
  constexpr double little = 0.05;  // of the length, allowed at the path's two ends
  if (std::isnan(path.touched_mm)) return PathContact::unknown;
  if (path.touched_mm >= (1 - little) * path.length_mm) return PathContact::all_along;
  return path.touched_mm <= little * path.length_mm ? PathContact::nowhere : PathContact::partly;
}

Marks marks_of(const RecordedSession& session) {
  Marks marks;
  MarkPresses presses;
  const auto keep = [&](std::optional<MarkMade> made) {
    if (!made) return;
    if (auto* const mark = std::get_if<FeltMark>(&*made)) {
      mark->name = free_mark_name(marks);
      marks.points.push_back(std::move(*mark));
    } else {
      auto& path = std::get<MarkedPath>(*made);
      path.name = free_path_name(marks);
      marks.paths.push_back(std::move(path));
    }
  };
  for (std::size_t n = 0; n < session.size(); ++n) {
    if ((session.tick(n).buttons & mark_button) == 0 && !presses.is_down()) continue;
    keep(presses.take({.tick = session.tick(n),
                       .time_s = session.time_s(n),
                       .proxy_mm = session.proxy_mm(n),
                       .shares = session.shares(n),
                       .scene = session.scene(n)}));
  }
  keep(presses.finish());
  for (std::size_t n = 1; n < marks.points.size(); ++n) marks.distances.push_back({.from = n - 1, .to = n});
  for (std::size_t n = 1; n + 1 < marks.points.size(); ++n) {
    marks.angles.push_back({.from = n - 1, .at = n, .to = n + 1});
  }
  measure_again(marks);
  return marks;
}

double distance_mm(const Marks& marks, std::size_t from, std::size_t to) {
  return glm::distance(marks.points[from].position_mm, marks.points[to].position_mm);
}

std::optional<double> angle_degrees(const Marks& marks, std::size_t from, std::size_t at, std::size_t to) {
  const glm::dvec3 before = marks.points[from].position_mm - marks.points[at].position_mm;
  const glm::dvec3 after = marks.points[to].position_mm - marks.points[at].position_mm;
  const double lengths = glm::length(before) * glm::length(after);
  if (lengths == 0) return std::nullopt;
  return glm::degrees(std::acos(std::clamp(glm::dot(before, after) / lengths, -1.0, 1.0)));
}

std::string free_mark_name(const Marks& marks) {
  return free_name("Mark", marks.points);
}

std::string free_path_name(const Marks& marks) {
  return free_name("Path", marks.paths);
}

void remove_mark(Marks& marks, std::size_t mark) {
  marks.points.erase(marks.points.begin() + static_cast<std::ptrdiff_t>(mark));
  std::erase_if(marks.distances, [&](const MarkedDistance& of) { return of.from == mark || of.to == mark; });
  std::erase_if(marks.angles, [&](const MarkedAngle& of) { return of.from == mark || of.at == mark || of.to == mark; });
  const auto shift = [&](std::size_t& index) {
    if (index > mark) --index;
  };
  for (MarkedDistance& of : marks.distances) {
    shift(of.from);
    shift(of.to);
  }
  for (MarkedAngle& of : marks.angles) {
    shift(of.from);
    shift(of.at);
    shift(of.to);
  }
}

void measure_again(Marks& marks) {
  for (MarkedDistance& of : marks.distances) of.mm = distance_mm(marks, of.from, of.to);
  std::erase_if(marks.angles, [&](const MarkedAngle& of) { return !angle_degrees(marks, of.from, of.at, of.to); });
  for (MarkedAngle& of : marks.angles) of.degrees = *angle_degrees(marks, of.from, of.at, of.to);
}

}  // namespace palpate::plugin
