#pragma once

/// Lets a client ask for single values of a scan on the server. It is not part of the pipeline and in no state file,
/// and asking changes nothing.

#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkWeakPointer.h>

#include <array>

#include "PalpateServerModule.h"
#include "plugin/paraview/server/module/PalpateDicomReader.h"

class PALPATESERVER_EXPORT PalpateValueProbe : public vtkObject {
 public:
  static PalpateValueProbe* New();
  vtkTypeMacro(PalpateValueProbe, vtkObject) void PrintSelf(ostream& os, vtkIndent indent) override;

  void SetReader(vtkObject* reader) { reader_ = PalpateDicomReader::SafeDownCast(reader); }
  /// Patient space, mm.
  void SetPosition(double x, double y, double z) { position_ = {x, y, z}; }
  /// As PalpateDicomReader::ValueAt().
  double GetValue();
  /// As PalpateDicomReader::GetValueShares(), empty if that is null.
  vtkDoubleArray* GetShares();
  /// As PalpateDicomReader::GetLightPart().
  double GetLightPart();

  PalpateValueProbe(const PalpateValueProbe&) = delete;
  PalpateValueProbe& operator=(const PalpateValueProbe&) = delete;

 protected:
  PalpateValueProbe() = default;

 private:
  vtkWeakPointer<PalpateDicomReader> reader_;
  std::array<double, 3> position_{};
  vtkNew<vtkDoubleArray> none_;
};
