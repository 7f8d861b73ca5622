#include "plugin/report/kept_marks.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/report/marks_json.h"

namespace palpate::plugin {
namespace {

using Json = nlohmann::ordered_json;

constexpr int version = 1;

Json json_of_all(const Marks& marks) {
  Json json{
      {"marks", Json::array()}, {"paths", Json::array()}, {"distances", Json::array()}, {"angles", Json::array()}};
  for (const FeltMark& mark : marks.points) json["marks"].push_back(json_of(mark));
  for (const MarkedPath& path : marks.paths) {
    Json points = Json::array();
    for (const glm::dvec3& point : path.points_mm) points.push_back(json_of(point));
    json["paths"].push_back({{"name", path.name},
                             {"begin_s", path.begin_s},
                             {"end_s", path.end_s},
                             {"touched_mm", std::isnan(path.touched_mm) ? Json() : Json(path.touched_mm)},
                             {"points_mm", points}});
  }
  for (const MarkedDistance& of : marks.distances) json["distances"].push_back(Json::array({of.from, of.to}));
  for (const MarkedAngle& of : marks.angles) json["angles"].push_back(Json::array({of.from, of.at, of.to}));
  return json;
}

[[noreturn]] void refuse(const std::string& what) {
  throw InvalidInput(say("marks-cannot-be-read", what));
}

double number_of(const Json& json) {
  const auto value = json.get<double>();
  if (!std::isfinite(value)) refuse("a number is not finite");
  return value;
}

glm::dvec3 place_of(const Json& json) {
  if (!json.is_array() || json.size() != 3) refuse("a place is not three numbers");
  return {number_of(json[0]), number_of(json[1]), number_of(json[2])};
}

/// Of marks that are there, each once.
template <std::size_t count>
std::array<std::size_t, count> indices_of(const Json& json, const Marks& marks) {
  if (!json.is_array() || json.size() != count) refuse("a measure is not between marks");
  std::array<std::size_t, count> indices{};
  for (std::size_t n = 0; n < count; ++n) {
    if (!json[n].is_number_unsigned() || json[n].get<std::size_t>() >= marks.points.size()) {
      refuse("a measure is not between marks");
    }
    indices[n] = json[n].get<std::size_t>();
    for (std::size_t before = 0; before < n; ++before) {
      if (indices[before] == indices[n]) refuse("a measure is not between marks");
    }
  }
  return indices;
}

Marks marks_of_json(const Json& json) {
  Marks marks;
  for (const Json& of : json.at("marks")) {
    const Json& value = of.at("value");
    marks.points.push_back({.name = of.at("name").get<std::string>(),
                            .tick = of.at("tick").get<std::uint64_t>(),
                            .time_s = number_of(of.at("time_s")),
                            .position_mm = place_of(of.at("position_mm")),
                            .boundary = of.at("boundary").get<std::string>(),
                            .value = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : number_of(value),
                            .force_n = number_of(of.at("force_n"))});
  }
  for (const Json& of : json.at("paths")) {
    MarkedPath path{.name = of.at("name").get<std::string>(),
                    .begin_s = number_of(of.at("begin_s")),
                    .end_s = number_of(of.at("end_s"))};
    const Json touched = of.value("touched_mm", Json());  // not known in marks of before 0.2
    path.touched_mm = touched.is_null() ? std::numeric_limits<double>::quiet_NaN() : number_of(touched);
    for (const Json& point : of.at("points_mm")) path.points_mm.push_back(place_of(point));
    if (path.points_mm.size() < 2) refuse("a path has no length");
    for (std::size_t n = 1; n < path.points_mm.size(); ++n) {
      path.length_mm += glm::distance(path.points_mm[n - 1], path.points_mm[n]);
    }
    marks.paths.push_back(std::move(path));
  }
  for (const Json& of : json.at("distances")) {
    const auto [from, to] = indices_of<2>(of, marks);
    marks.distances.push_back({.from = from, .to = to});
  }
  for (const Json& of : json.at("angles")) {
    const auto [from, at, to] = indices_of<3>(of, marks);
    marks.angles.push_back({.from = from, .at = at, .to = to});
  }
  measure_again(marks);
  return marks;
}

bool is_empty(const Marks& marks) {
  return marks.points.empty() && marks.paths.empty();
}

}  // namespace

std::string kept_text(const MarksOfScans& marks) {
  Json scans = Json::object();
  for (const auto& [scan, of] : marks) {
    if (!is_empty(of)) scans[scan] = json_of_all(of);
  }
  if (scans.empty()) return {};
  return Json{{"version", version}, {"scans", scans}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

MarksOfScans marks_of_text(const std::string& text) {
  if (text.empty()) return {};
  try {
    const Json json = Json::parse(text);
    if (json.at("version").get<int>() != version) refuse("they are of another version");
    MarksOfScans marks;
    for (const auto& [scan, of] : json.at("scans").items()) marks[scan] = marks_of_json(of);
    return marks;
  } catch (const Json::exception& error) {
    refuse(error.what());
  }
}

}  // namespace palpate::plugin
