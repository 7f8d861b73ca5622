#pragma once

/// Writes the marks and measurements of a series as DICOM objects of its study: a Comprehensive 3D SR by template TID
/// 1500 (DICOM PS3.16), and pictures as Secondary Capture.

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/series.h"

namespace palpate::io {

/// A point in patient space (LPS, mm), with the felt boundary, value and force. Texts are UTF-8.
struct MarkedPoint {
  std::string name;
  glm::dvec3 position_mm{0};
  std::string structure;          ///< the felt boundary, or empty
  std::optional<double> value;    ///< of the scan, in the series' unit
  std::optional<double> force_n;  ///< N, on the stylus
};

/// The length of a line through points: two for a distance, more for a path.
struct MeasuredLength {
  std::string name;
  std::vector<glm::dvec3> points_mm;
  double length_mm = 0;
};

/// The angle at the second of three points, between the lines to the first and the third.
struct MeasuredAngle {
  std::string name;
  std::array<glm::dvec3, 3> points_mm;
  double degrees = 0;
};

struct MeasurementReport {
  std::string software_version;
  std::vector<MarkedPoint> points;
  std::vector<MeasuredLength> lengths;
  std::vector<MeasuredAngle> angles = {};
};

/// Writes the report with references to the series' images. Patient and study are copied from their headers. Throws
/// DicomError that names the file that cannot be read or written, or the attribute that the series lacks.
void write_measurement_report(const Series& series, const MeasurementReport& report, const std::filesystem::path& file);

/// 8-bit red, green, blue; row by row from the upper left.
struct Picture {
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> pixels;
  std::string description;
};

/// Writes the pictures as one new series of the study, one file for each: picture-001.dcm and so on. Throws as above.
void write_pictures(const Series& series, const std::string& software_version, std::span<const Picture> pictures,
                    const std::filesystem::path& folder);

}  // namespace palpate::io
