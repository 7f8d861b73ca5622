#include "plugin/paraview/server/module/PalpateTissueSurface.h"

#include <vtkCleanPolyData.h>
#include <vtkDataArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

#include "plugin/paraview/common/all_cores.h"
#include "plugin/paraview/server/module/pieces.h"

using namespace palpate;

vtkStandardNewMacro(PalpateTissueSurface);

void PalpateTissueSurface::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
  for (const double value : values_) os << indent << "Value: " << value << "\n";
}

void PalpateTissueSurface::SetValue(int index, double value) {
  values_.at(static_cast<std::size_t>(index)) = value;
  Modified();
}

void PalpateTissueSurface::SetNumberOfValues(int count) {
  values_.resize(static_cast<std::size_t>(count));
  Modified();
}

int PalpateTissueSurface::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int PalpateTissueSurface::RequestUpdateExtent(vtkInformation* request, vtkInformationVector** input,
                                              vtkInformationVector* output) {
  vtkInformation& asked = *output->GetInformationObject(0);
  // Normals at the border of a rank's part are slopes over that border.
  const int reach = plugin::pieces_of(asked) > 1 ? 1 : 0;
  plugin::ask_for_ghosts(*input[0]->GetInformationObject(0), asked, reach);
  return Superclass::RequestUpdateExtent(request, input, output);
}

namespace {

/// Removes the surface in cells outside `extent`, which a neighboring rank has as well.
void keep_within(const std::array<int, 6>& extent, vtkImageData& image, vtkPolyData& surface) {
  surface.BuildCells();
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < surface.GetNumberOfCells(); ++cell) {
    surface.GetCellPoints(cell, corners);
    glm::dvec3 middle(0);
    for (const vtkIdType corner : *corners) {
      glm::dvec3 place;
      surface.GetPoint(corner, &place.x);
      middle += place / static_cast<double>(corners->GetNumberOfIds());
    }
    glm::dvec3 index;
    image.TransformPhysicalPointToContinuousIndex(&middle.x, &index.x);
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t low = 2 * static_cast<std::size_t>(axis);
      if (index[axis] < extent[low] || index[axis] >= extent[low + 1]) {
        surface.DeleteCell(cell);
        break;
      }
    }
  }
  surface.RemoveDeletedCells();
  vtkNew<vtkCleanPolyData> without_lone_points;
  without_lone_points->PointMergingOff();
  without_lone_points->SetInputData(&surface);
  without_lone_points->Update();
  surface.ShallowCopy(without_lone_points->GetOutput());
}

}  // namespace

int PalpateTissueSurface::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output) {
  vtkImageData& image = *vtkImageData::GetData(input[0]);
  vtkDataArray* const scalars = image.GetPointData()->GetScalars();
  // A part of one voxel's thickness, or none, holds no cell: MPI ranks may get such.
  const int* const size = image.GetDimensions();
  if (!scalars || size[0] < 2 || size[1] < 2 || size[2] < 2) return 1;

  vtkNew<vtkImageData> scan;  // without the arrays that other filters added: flying edges would interpolate them all
  scan->CopyStructure(&image);
  scan->GetPointData()->SetScalars(scalars);
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(scan);
  edges->ComputeNormalsOn();
  edges->ComputeScalarsOn();
  edges->SetNumberOfContours(static_cast<int>(values_.size()));
  for (std::size_t n = 0; n < values_.size(); ++n) edges->SetValue(static_cast<int>(n), values_[n]);
  plugin::on_all_cores([&] { edges->Update(); });
  vtkPolyData& surface = *vtkPolyData::GetData(output);
  surface.ShallowCopy(edges->GetOutput());
  vtkInformation& asked = *output->GetInformationObject(0);
  if (plugin::pieces_of(asked) > 1) keep_within(plugin::own_extent(image, plugin::ghosts_of(asked)), image, surface);
  return 1;
}
