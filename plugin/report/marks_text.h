#pragma once

/// Marks as text for other programs. Patient space (LPS, mm). The patient is not named.

#include <string>

#include "plugin/recording/marks.h"

namespace palpate::plugin {

/// A line for each mark, path, distance and angle.
std::string marks_as_csv(const Marks& marks);
/// `unit` is that of the scan's values, or empty.
std::string marks_as_json(const Marks& marks, const std::string& unit);
/// 3D Slicer's markups, schema 1.0.3: the marks as points, distances as lines, angles as angles, paths as curves.
std::string marks_as_markups(const Marks& marks);

}  // namespace palpate::plugin
