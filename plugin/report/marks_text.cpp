#include "plugin/report/marks_text.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "plugin/report/marks_json.h"

namespace palpate::plugin {
namespace {

using Json = nlohmann::ordered_json;

/// A cell of a CSV table, RFC 4180.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c;
    if (c == '"') quoted += c;
  }
  return quoted + "\"";
}

std::string text_of(const Json& json) {
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json control_point(std::size_t number, const std::string& label, const std::string& description, const glm::dvec3& at) {
  return {{"id", std::to_string(number)},
          {"label", label},
          {"description", description},
          {"associatedNodeID", ""},
          {"position", json_of(at)},
          {"orientation", {-1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0}},
          {"selected", true},
          {"locked", false},
          {"visibility", true},
          {"positionStatus", "defined"}};
}

Json markup(const char* type, const std::string& name, const Json& points) {
  return {{"type", type},
          {"name", name},
          {"coordinateSystem", "LPS"},
          {"coordinateUnits", "mm"},
          {"locked", true},
          {"labelFormat", "%N"},
          {"lastUsedControlPointNumber", points.size()},
          {"controlPoints", points}};
}

}  // namespace

std::string marks_as_csv(const Marks& marks) {
  std::string csv = "kind,name,time_s,x_mm,y_mm,z_mm,boundary,value,force_n,length_mm,angle_deg\n";
  for (const FeltMark& mark : marks.points) {
    csv += fmt::format("mark,{},{:.3f},{:.4f},{:.4f},{:.4f},{},{},{:.4f},,\n", cell(mark.name), mark.time_s,
                       mark.position_mm.x, mark.position_mm.y, mark.position_mm.z, cell(mark.boundary),
                       std::isfinite(mark.value) ? fmt::format("{:.6g}", mark.value) : "", mark.force_n);
  }
  for (const MarkedPath& path : marks.paths) {
    csv += fmt::format("path,{},{:.3f},{:.4f},{:.4f},{:.4f},,,,{:.4f},\n", cell(path.name), path.begin_s,
                       path.points_mm.front().x, path.points_mm.front().y, path.points_mm.front().z, path.length_mm);
  }
  for (const MarkedDistance& distance : marks.distances) {
    const std::string name = marks.points[distance.from].name + " to " + marks.points[distance.to].name;
    csv += fmt::format("distance,{},,,,,,,,{:.4f},\n", cell(name), distance.mm);
  }
  for (const MarkedAngle& angle : marks.angles) {
    csv += fmt::format("angle,{},,,,,,,,,{:.3f}\n", cell(marks.points[angle.at].name), angle.degrees);
  }
  return csv;
}

std::string marks_as_json(const Marks& marks, const std::string& unit) {
  Json json{{"marks", Json::array()},
            {"paths", Json::array()},
            {"distances", Json::array()},
            {"angles", Json::array()},
            {"unit", unit}};
  for (const FeltMark& mark : marks.points) json["marks"].push_back(json_of(mark));
  for (const MarkedPath& path : marks.paths) {
    Json points = Json::array();
    for (const glm::dvec3& point : path.points_mm) points.push_back(json_of(point));
    json["paths"].push_back({{"name", path.name},
                             {"begin_s", path.begin_s},
                             {"end_s", path.end_s},
                             {"length_mm", path.length_mm},
                             {"touched_mm", std::isnan(path.touched_mm) ? Json() : Json(path.touched_mm)},
                             {"points_mm", points}});
  }
  for (const MarkedDistance& distance : marks.distances) {
    json["distances"].push_back({{"from", marks.points[distance.from].name},
                                 {"to", marks.points[distance.to].name},
                                 {"length_mm", distance.mm}});
  }
  for (const MarkedAngle& angle : marks.angles) {
    json["angles"].push_back({{"at", marks.points[angle.at].name}, {"degrees", angle.degrees}});
  }
  return text_of(json);
}

std::string marks_as_markups(const Marks& marks) {
  Json all = Json::array();
  Json points = Json::array();
  for (const FeltMark& mark : marks.points) {
    points.push_back(control_point(points.size() + 1, mark.name, mark.boundary, mark.position_mm));
  }
  if (!points.empty()) all.push_back(markup("Fiducial", "Marks", points));
  const auto point_of = [&](std::size_t number, std::size_t mark) {
    return control_point(number, marks.points[mark].name, "", marks.points[mark].position_mm);
  };
  for (const MarkedDistance& distance : marks.distances) {
    all.push_back(markup("Line", marks.points[distance.from].name + " to " + marks.points[distance.to].name,
                         Json::array({point_of(1, distance.from), point_of(2, distance.to)})));
  }
  for (const MarkedAngle& angle : marks.angles) {
    all.push_back(markup("Angle", "Angle at " + marks.points[angle.at].name,
                         Json::array({point_of(1, angle.from), point_of(2, angle.at), point_of(3, angle.to)})));
  }
  for (const MarkedPath& path : marks.paths) {
    Json curve = Json::array();
    for (const glm::dvec3& point : path.points_mm) {
      curve.push_back(control_point(curve.size() + 1, fmt::format("{}-{}", path.name, curve.size() + 1), "", point));
    }
    all.push_back(markup("Curve", path.name, curve));
  }
  return text_of({{"@schema",
                   "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
                   "markups-schema-v1.0.3.json#"},
                  {"markups", all}});
}

}  // namespace palpate::plugin
