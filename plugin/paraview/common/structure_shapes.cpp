#include "plugin/paraview/common/structure_shapes.h"

#include <vtkFloatArray.h>
#include <vtkFlyingEdges2D.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::plugin {
namespace {

constexpr double finest_mm = 0.25;
constexpr int most_across_a_sheet = 600, most_across_a_box = 160;
constexpr int block = 8;  // nodes a side: sampled once where the surface is far away

/// A lattice with the distance at each node near `at_mm`; elsewhere only its sign is right.
template <typename PlaceOf>
vtkSmartPointer<vtkImageData> sampled(const io::DistanceField& distance, const glm::ivec3& size, double step,
                                      const PlaceOf& place_of, double at_mm = 0) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(size.x, size.y, size.z);
  image->SetSpacing(step, step, step);
  image->AllocateScalars(VTK_FLOAT, 1);
  auto* const values = static_cast<float*>(image->GetScalarPointer());
  const glm::ivec3 blocks = (size + block - 1) / block;
  const double far_mm = 1.5 * step * block;  // farther than half a block's diagonal, by more than the distance errs
  for (int b = 0; b < blocks.x * blocks.y * blocks.z; ++b) {
    const glm::ivec3 first = block * glm::ivec3(b % blocks.x, b / blocks.x % blocks.y, b / (blocks.x * blocks.y));
    const glm::ivec3 end(std::min(first.x + block, size.x), std::min(first.y + block, size.y),
                         std::min(first.z + block, size.z));
    const double middle = distance.sample(place_of(0.5 * glm::dvec3(first + end - 1))).mm;
    for (int k = first.z; k < end.z; ++k) {
      for (int j = first.y; j < end.y; ++j) {
        for (int i = first.x; i < end.x; ++i) {
          const double mm =
              std::abs(middle - at_mm) > far_mm ? middle : distance.sample(place_of(glm::dvec3(i, j, k))).mm;
          values[(static_cast<std::ptrdiff_t>(k) * size.y + j) * size.x + i] = static_cast<float>(mm);
        }
      }
    }
  }
  return image;
}

int nodes(double size_mm, double step) {
  return std::max(2, static_cast<int>(std::ceil(size_mm / step)) + 1);
}

}  // namespace

vtkSmartPointer<vtkPolyData> outline_of(const io::DistanceField& distance, const Sheet& sheet, double at_mm) {
  const double step = std::max(finest_mm, std::max(sheet.size_mm.x, sheet.size_mm.y) / most_across_a_sheet);
  const auto place_of = [&](const glm::dvec3& node) {
    return sheet.corner + step * (node.x * sheet.right + node.y * sheet.up);
  };
  vtkNew<vtkFlyingEdges2D> contour;
  contour->SetInputData(
      sampled(distance, {nodes(sheet.size_mm.x, step), nodes(sheet.size_mm.y, step), 1}, step, place_of, at_mm));
  contour->SetValue(0, at_mm);
  contour->ComputeScalarsOff();
  contour->Update();
  vtkSmartPointer<vtkPolyData> lines = contour->GetOutput();
  vtkPoints* const points = lines->GetPoints();
  for (vtkIdType n = 0; points && n < points->GetNumberOfPoints(); ++n) {
    glm::dvec3 at;
    points->GetPoint(n, &at.x);
    const glm::dvec3 place = place_of(at / step);
    points->SetPoint(n, place.x, place.y, place.z);
  }
  return lines;
}

vtkSmartPointer<vtkPolyData> surface_of(const io::DistanceField& distance, const glm::dvec3& low_mm,
                                        const glm::dvec3& high_mm) {
  const glm::dvec3 extent = high_mm - low_mm;
  const double step = std::max(2 * finest_mm, std::max({extent.x, extent.y, extent.z}) / most_across_a_box);
  const glm::ivec3 size(nodes(extent.x, step), nodes(extent.y, step), nodes(extent.z, step));
  vtkNew<vtkFlyingEdges3D> contour;
  const auto image = sampled(distance, size, step, [&](const glm::dvec3& node) { return low_mm + step * node; });
  image->SetOrigin(low_mm.x, low_mm.y, low_mm.z);
  contour->SetInputData(image);
  contour->SetValue(0, 0.0);
  contour->ComputeNormalsOn();
  contour->ComputeScalarsOff();
  contour->Update();
  return contour->GetOutput();
}

}  // namespace palpate::plugin
