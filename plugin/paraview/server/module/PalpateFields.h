#pragma once

/// The fields that the stylus samples, at every voxel: the gradient and its magnitude, and the felt strength. The felt
/// strength is the force with which the boundaries of a scene resist there before they yield.
///
/// For a scan from Palpate's reader the fields are those of the whole scan, even if the image is only a part of it or
/// several ranks share it. For any other image they are those of the image.

#include <vtkImageAlgorithm.h>

#include <string>

#include "PalpateServerModule.h"

class PALPATESERVER_EXPORT PalpateFields : public vtkImageAlgorithm {
 public:
  static PalpateFields* New();
  vtkTypeMacro(PalpateFields, vtkImageAlgorithm) void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Which arrays are made: "Gradient" (unit per mm, patient axes), "Gradient magnitude", "Felt strength" (N).
  void SetMakeGradient(bool on);
  void SetMakeMagnitude(bool on);
  void SetMakeFeltStrength(bool on);
  /// Scale of the gradient's Gaussian, mm; 0: the scene's, or the scan's default.
  void SetScale(double scale_mm);
  /// Scene as JSON, starting scene or file; empty: the one that suits the scan.
  void SetScene(const char* scene);
  /// The mode whose strength is shown, by its name in the scene; empty: all surfaces together.
  void SetMode(const char* name);

  PalpateFields(const PalpateFields&) = delete;
  PalpateFields& operator=(const PalpateFields&) = delete;

 protected:
  PalpateFields() = default;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

 private:
  bool make_gradient_ = false;
  bool make_magnitude_ = true;
  bool make_felt_ = true;
  double scale_mm_ = 0;
  std::string scene_;
  std::string mode_;
};
