#pragma once

/// The lines and surfaces that show a structure: where its distance is zero, which is also where it is felt.

#include <vtkSmartPointer.h>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "PalpateServerModule.h"
#include "io/structures/distance_field.h"

class vtkPolyData;

namespace palpate::plugin {

/// A rectangle of a plane in the patient, mm.
struct Sheet {
  glm::dvec3 corner{0};
  glm::dvec3 right{1, 0, 0}, up{0, 1, 0};  ///< unit
  glm::dvec2 size_mm{0};
};

/// Lines in the plane, patient space, where the distance is `at_mm`; none if that is nowhere in the plane.
PALPATESERVER_EXPORT vtkSmartPointer<vtkPolyData> outline_of(const io::DistanceField& distance, const Sheet& sheet,
                                                             double at_mm = 0);

/// Its surface within a box, patient space.
PALPATESERVER_EXPORT vtkSmartPointer<vtkPolyData> surface_of(const io::DistanceField& distance,
                                                             const glm::dvec3& low_mm, const glm::dvec3& high_mm);

}  // namespace palpate::plugin
