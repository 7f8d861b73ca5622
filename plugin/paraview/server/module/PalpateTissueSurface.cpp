#include "PalpateTissueSurface.h"

#include <vtkDataArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

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
  edges->Update();
  vtkPolyData::GetData(output)->ShallowCopy(edges->GetOutput());
  return 1;
}
