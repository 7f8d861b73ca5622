#pragma once

/// The lines and surfaces drawn in a clinical view.

#include <QColor>

#include <glm/vec3.hpp>
#include <vector>

struct DrawnLines {
  double pixels = 0;               ///< line width
  std::vector<glm::dvec3> points;  ///< patient space, mm
  double width_mm() const;         ///< extent from the patient's right to the left
};

/// Each actor of lines of that color.
std::vector<DrawnLines> lines_drawn_in(const char* view, const QColor& color);

/// The least coordinates of all surfaces of that color; 0 if there is none.
glm::dvec3 least_of_surface_in(const char* view, const QColor& color);
