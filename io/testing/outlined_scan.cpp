#include "io/testing/outlined_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace palpate::io::testing {
namespace {

std::vector<Vec3> stack(const Vec3& first, const Vec3& step, const std::vector<double>& heights) {
  std::vector<Vec3> positions;
  for (const double height : heights) positions.push_back(first + height * step);
  return positions;
}

std::string in_text(const std::vector<Vec3>& vectors) {
  std::string text;
  for (const Vec3& v : vectors) {
    for (int n = 0; n < 3; ++n) text += fmt::format("{}{:.9g}", text.empty() ? "" : "\\", v[n]);
  }
  return text;
}

std::vector<ScanKind> make_scan_kinds() {
  const std::vector<double> even{0, 1, 2, 3, 4, 5, 6, 7, 8};
  const Vec3 first(-101.25, -57.5, -785.125);
  const Vec3 i = glm::normalize(Vec3(0.9, 0.3, -0.2));
  const Vec3 j = glm::normalize(glm::cross(glm::normalize(glm::cross(i, Vec3(0.1, 1, 0.4))), i));
  const Vec3 normal = glm::cross(i, j);
  return {{"axial", {1, 0, 0}, {0, 1, 0}, stack(first, {0, 0, 2}, even)},
          {"oblique", i, j, stack(first, 1.5 * normal, even)},
          {"tilted", {1, 0, 0}, {0, std::cos(0.3), std::sin(0.3)}, stack(first, {0, 0, 2}, even)},
          {"uneven", {1, 0, 0}, {0, 1, 0}, stack(first, {0, 0, 1}, {0, 1, 2, 4, 6.5, 7.25, 9, 11, 14})},
          {"one slice", {1, 0, 0}, {0, 1, 0}, {first}},
          {"feet first", {-1, 0, 0}, {0, 1, 0}, stack(first, {0, 0, -2}, even)},
          {"slices missing", {1, 0, 0}, {0, 1, 0}, stack(first, {0, 0, 2}, {0, 1, 2, 3, 5, 6, 7, 8})}};
}

}  // namespace

const std::vector<ScanKind>& scan_kinds() {
  static const std::vector<ScanKind> all = make_scan_kinds();
  return all;
}

const ScanKind& scan_kind(const std::string& name) {
  const auto found = std::ranges::find(scan_kinds(), name, &ScanKind::name);
  if (found == scan_kinds().end()) throw std::logic_error("no scan of kind " + name);
  return *found;
}

Series write_scan(const ScanKind& kind, const std::filesystem::path& folder) {
  using internal::put;
  std::filesystem::create_directories(folder);
  internal::write_stack(folder, static_cast<int>(kind.positions.size()), [&](int k, internal::TestImage& image) {
    image.columns = ScanKind::columns;
    image.rows = ScanKind::rows;
    image.edit = [&kind, k](DcmDataset& data) {
      put(data, DCM_ImagePositionPatient, in_text({kind.positions[static_cast<std::size_t>(k)]}));
      put(data, DCM_ImageOrientationPatient, in_text({kind.direction_i, kind.direction_j}));
      put(data, DCM_PixelSpacing, "1.25\\0.75");
      put(data, DCM_SpecificCharacterSet, "ISO_IR 100");
      put(data, DCM_PatientName, "M\xFCller^Zo\xEB");
      put(data, DCM_PatientID, "4711");
      put(data, DCM_StudyDate, "20240229");
      put(data, DCM_SeriesNumber, "7");
      put(data, DCM_FrameOfReferenceUID, "1.2.3.9");
      put(data, DCM_InstanceNumber, std::to_string(k + 1));
    };
  });
  const Catalogue found = find_series(std::array{folder});
  if (found.series.size() != 1) throw std::logic_error("no series of kind " + kind.name);
  return found.series.front();
}

std::vector<Shape> shapes_in(const Geometry& scan) {
  const Vec3 middle = scan.to_patient(Vec3(scan.dimensions - 1) / 2.0), corner = scan.to_patient(Vec3(0));
  const Vec3 along = 3.0 * scan.direction_i;
  const auto ball = [](const Vec3& center, double radius) {
    return [=](const Vec3& at) { return radius - glm::length(at - center); };
  };
  return {{"ball", ball(middle, 4.3)},
          {"shell and ball",
           [=](const Vec3& at) {
             const double r = glm::length(at - middle);
             return std::max(std::min(5.2 - r, r - 3.4), 1.7 - r);
           }},
          {"two balls",
           [=](const Vec3& at) { return std::max(ball(middle - along, 2.1)(at), ball(middle + along, 1.6)(at)); }},
          {"corner", ball(corner, 4.1)}};
}

StructureLabel full_label() {
  StructureLabel label{.name = "Lébèr Größe 肝", .color = "#d98265"};
  label.category = {"123037004", "SCT", "Anatomical Structure"};
  label.type = {"10200004", "SCT", "Liver"};
  label.modifiers = {{"24028007", "SCT", "Right"}};
  label.tracking_id = "Läsion 1";
  label.tracking_uid = "1.2.3.4.5";
  label.interpreted_type = "ORGAN";
  return label;
}

}  // namespace palpate::io::testing
