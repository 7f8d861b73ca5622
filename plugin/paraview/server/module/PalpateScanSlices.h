#pragma once

/// Carries the requests of a client for voxels to the PalpateDicomReader of a server, and the answers back. Only the
/// first rank answers, a few slices at a time.

#include <vtkPVInformation.h>

#include <memory>

#include "PalpateServerModule.h"

#ifndef __VTK_WRAP__  // whose parser is older
namespace palpate::plugin {
struct SlicesAsked;
struct SlicesAnswered;
}  // namespace palpate::plugin
#endif

class PALPATESERVER_EXPORT PalpateScanSlices : public vtkPVInformation {
 public:
  static PalpateScanSlices* New();
  vtkTypeMacro(PalpateScanSlices, vtkPVInformation) void PrintSelf(ostream& os, vtkIndent indent) override;

#ifndef __VTK_WRAP__
  palpate::plugin::SlicesAsked& asked() {
    return *asked_;
  }
  palpate::plugin::SlicesAnswered& answered() {
    return *answered_;
  }
#endif

  void CopyFromObject(vtkObject* reader) override;
  void CopyToStream(vtkClientServerStream* stream) override;
  void CopyFromStream(const vtkClientServerStream* stream) override;
  void CopyParametersToStream(vtkMultiProcessStream& stream) override;
  void CopyParametersFromStream(vtkMultiProcessStream& stream) override;

  PalpateScanSlices(const PalpateScanSlices&) = delete;
  PalpateScanSlices& operator=(const PalpateScanSlices&) = delete;

 protected:
  PalpateScanSlices();
  ~PalpateScanSlices() override;

#ifndef __VTK_WRAP__
 private:
  std::unique_ptr<palpate::plugin::SlicesAsked> asked_;
  std::unique_ptr<palpate::plugin::SlicesAnswered> answered_;
#endif
};
