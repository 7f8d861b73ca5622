#pragma once

/// A slice of a scan with a session's tracks of probe and proxy, and force arrows. Patient space (LPS, mm).

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/fields/field_source.h"
#include "plugin/report/canvas.h"

namespace palpate::plugin {

/// The plane and its gray window. `right` and `down` are the screen's directions in the patient: unit and
/// perpendicular.
struct SliceView {
  glm::dvec3 center_mm{0};
  glm::dvec3 right{1, 0, 0};
  glm::dvec3 down{0, 1, 0};
  double extent_mm = 100;  ///< shown across the picture's width
  double window_level = 40;
  double window_width = 400;
};

struct Track {
  std::string label;
  std::vector<glm::dvec3> points_mm;
  Color color;
  double width = 2;
};

/// A force drawn from a point along its direction in the patient.
struct ForceArrow {
  glm::dvec3 at_mm{0};
  glm::dvec3 force_n{0};
};

/// The letters of a direction in the patient: "L", "P", "H", or two ("LP") if it is oblique.
std::string orientation_letters(const glm::dvec3& direction);

Canvas draw_slice(const io::FieldSource& source, const SliceView& view, std::span<const Track> tracks,
                  std::span<const ForceArrow> arrows, const std::string& title, int width = 960, int height = 760);

/// Writes the same picture to a file. Throws std::runtime_error naming it.
void write_slice_png(const io::FieldSource& source, const SliceView& view, std::span<const Track> tracks,
                     std::span<const ForceArrow> arrows, const std::string& title, const std::filesystem::path& file,
                     int width = 960, int height = 760);

}  // namespace palpate::plugin
