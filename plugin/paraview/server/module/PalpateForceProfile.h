#pragma once

/// The force along a straight stroke through a scan, as a table for ParaView's chart. It has a row for each millisecond
/// of the stroke, with the numbers of `palpate profile`. On a parallel server the first rank has the table.

#include <vtkTableAlgorithm.h>

#include <array>
#include <string>

#include "PalpateServerModule.h"

class PALPATESERVER_EXPORT PalpateForceProfile : public vtkTableAlgorithm {
 public:
  static PalpateForceProfile* New();
  vtkTypeMacro(PalpateForceProfile, vtkTableAlgorithm) void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Ends of the stroke, patient space, mm.
  void SetPoint1(double x, double y, double z);
  void SetPoint2(double x, double y, double z);
  /// mm/s
  void SetSpeed(double speed);
  /// Scene as JSON, starting scene or file; empty: the one that suits the scan.
  void SetScene(const char* scene);

  PalpateForceProfile(const PalpateForceProfile&) = delete;
  PalpateForceProfile& operator=(const PalpateForceProfile&) = delete;

 protected:
  PalpateForceProfile() = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  std::array<double, 3> from_{};
  std::array<double, 3> to_{};
  double speed_ = 50;
  std::string scene_;
};
