#pragma once

/// The surface on which a scan has a value, with normals: flying edges, which follow oblique and tilted scans where
/// ParaView's own Contour does not.

#include <vtkPolyDataAlgorithm.h>

#include <vector>

#include "PalpateServerModule.h"

class PALPATESERVER_EXPORT PalpateTissueSurface : public vtkPolyDataAlgorithm {
 public:
  static PalpateTissueSurface* New();
  vtkTypeMacro(PalpateTissueSurface, vtkPolyDataAlgorithm) void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Values in the scan's unit, a surface each.
  void SetValue(int index, double value);
  void SetNumberOfValues(int count);

  PalpateTissueSurface(const PalpateTissueSurface&) = delete;
  PalpateTissueSurface& operator=(const PalpateTissueSurface&) = delete;

 protected:
  PalpateTissueSurface() = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  std::vector<double> values_;
};
