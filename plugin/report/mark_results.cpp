#include "plugin/report/mark_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plugin/report/mark_pictures.h"
#include "plugin/report/summary.h"

namespace palpate::plugin {
namespace {

std::string contact_in_words(const MarkedPath& path) {
  switch (contact_of(path)) {
    case PathContact::nowhere:
      return ", without contact";
    case PathContact::partly:
      return fmt::format(", {:.1f} mm of it in contact", path.touched_mm);
    case PathContact::all_along:
      return ", along a boundary";
    case PathContact::unknown:
      break;
  }
  return {};
}

}  // namespace

io::MeasurementReport report_of(const Marks& marks) {
  io::MeasurementReport report{.software_version = PALPATE_VERSION};
  for (const FeltMark& mark : marks.points) {
    io::MarkedPoint point{.name = mark.name, .position_mm = mark.position_mm, .structure = mark.boundary};
    if (std::isfinite(mark.value)) point.value = mark.value;
    point.force_n = mark.force_n;
    report.points.push_back(point);
  }
  for (const MarkedDistance& distance : marks.distances) {
    const FeltMark& from = marks.points[distance.from];
    const FeltMark& to = marks.points[distance.to];
    report.lengths.push_back({from.name + " to " + to.name, {from.position_mm, to.position_mm}, distance.mm});
  }
  for (const MarkedPath& path : marks.paths) {
    report.lengths.push_back({path.name + contact_in_words(path), path.points_mm, path.length_mm});
  }
  for (const MarkedAngle& angle : marks.angles) {
    const FeltMark &from = marks.points[angle.from], &at = marks.points[angle.at], &to = marks.points[angle.to];
    report.angles.push_back({fmt::format("Angle at {}, from {} to {}", at.name, from.name, to.name),
                             {from.position_mm, at.position_mm, to.position_mm},
                             angle.degrees});
  }
  return report;
}

std::string report_in_words(const io::MeasurementReport& report, const std::string& unit) {
  std::string text;
  for (const io::MarkedPoint& point : report.points) {
    text += fmt::format("{}: {}", point.name, patient_coordinates(point.position_mm));
    text += point.structure.empty() ? ", no boundary felt" : ", felt boundary: " + point.structure;
    if (point.value) text += fmt::format(", value {:.6g}{}", *point.value, unit.empty() ? "" : " " + unit);
    if (point.force_n) text += fmt::format(", {:.2f} N", *point.force_n);
    text += '\n';
  }
  for (const io::MeasuredLength& length : report.lengths) {
    text += fmt::format("{}: {:.1f} mm\n", length.name, length.length_mm);
  }
  for (const io::MeasuredAngle& angle : report.angles) {
    text += fmt::format("{}: {:.1f} degrees\n", angle.name, angle.degrees);
  }
  return text;
}

std::vector<std::filesystem::path> write_results(const io::Series& series,
                                                 const std::shared_ptr<const io::Volume>& volume, const Marks& marks,
                                                 const std::filesystem::path& folder) {
  io::write_measurement_report(series, report_of(marks), folder / "measurements.dcm");
  io::write_pictures(series, PALPATE_VERSION, pictures_of(marks, volume), folder);
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());  // "measurements", then "picture"
  return files;
}

}  // namespace palpate::plugin
