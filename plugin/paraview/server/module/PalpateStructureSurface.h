#pragma once

/// The surface of an outlined structure (a segment of a DICOM SEG, an ROI of an RTSTRUCT, a label of a label map) on a
/// scan, with normals, in patient space (LPS, mm). It lies where the distance is zero. There it is felt, too.
///
/// A structure that cannot be felt on the scan is refused with the same message as a scene that names it.

#include <vtkPolyDataAlgorithm.h>

#include <string>

#include "PalpateServerModule.h"

class PALPATESERVER_EXPORT PalpateStructureSurface : public vtkPolyDataAlgorithm {
 public:
  static PalpateStructureSurface* New();
  vtkTypeMacro(PalpateStructureSurface, vtkPolyDataAlgorithm) void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The file that holds the structure, read where the server runs.
  void SetFileName(const char* name);
  /// Its name there, as `palpate structures` lists it.
  void SetSegment(const char* name);
  /// Its number there; 0: it is named by SetSegment().
  void SetSegmentNumber(int number);

  PalpateStructureSurface(const PalpateStructureSurface&) = delete;
  PalpateStructureSurface& operator=(const PalpateStructureSurface&) = delete;

 protected:
  PalpateStructureSurface() = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  std::string file_;
  std::string segment_;
  int segment_number_ = 0;
};
