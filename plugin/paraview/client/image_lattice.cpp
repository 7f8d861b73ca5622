#include "image_lattice.h"

#include <vtkDataSetAttributes.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkPVDataSetAttributesInformation.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>

#include <stdexcept>

namespace palpate::plugin {

glm::dvec3 ImageLattice::center() const {
  glm::dvec3 position = origin;
  for (int axis = 0; axis < 3; ++axis) {
    position += 0.5 * (dimensions[axis] - 1) * spacing[axis] * directions[static_cast<std::size_t>(axis)];
  }
  return position;
}

ImageLattice lattice_of(vtkSMSourceProxy& source) {
  source.UpdatePropertyInformation();
  const auto numbers = vtkSMPropertyHelper(&source, "Lattice").GetDoubleArray();
  if (numbers.size() != 18 || numbers[0] < 1)
    throw std::runtime_error("this series could not be read: see the messages");
  const auto row = [&](std::size_t n) { return glm::dvec3(numbers[3 * n], numbers[3 * n + 1], numbers[3 * n + 2]); };
  ImageLattice lattice;
  lattice.dimensions = glm::ivec3(row(0));
  lattice.spacing = row(1);
  lattice.origin = row(2);
  lattice.directions = {row(3), row(4), row(5)};
  vtkPVDataSetAttributesInformation& points = *source.GetDataInformation(0)->GetPointDataInformation();
  vtkPVArrayInformation* const scalars = points.GetAttributeInformation(vtkDataSetAttributes::SCALARS);
  if (!scalars) throw std::runtime_error("this series has no values: see the messages");
  lattice.array = scalars->GetName();
  lattice.hounsfield = lattice.array == "HU";
  lattice.low = scalars->GetComponentRange(0)[0];
  lattice.high = scalars->GetComponentRange(0)[1];
  return lattice;
}

}  // namespace palpate::plugin
