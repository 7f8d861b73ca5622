#include "plugin/paraview/client/layout/view_picture.h"

#include <pqRenderView.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSMViewLayoutProxy.h>
#include <vtkSmartPointer.h>

#include "plugin/paraview/client/layout/enlarged_view.h"

namespace palpate::plugin {

bool save_picture(pqRenderView& marked, const QString& file) {
  vtkSMViewLayoutProxy* const layout = layout_of(marked);
  const bool alone = !layout || is_enlarged(marked);
  const auto picture = vtkSmartPointer<vtkImageData>::Take(alone ? marked.getRenderViewProxy()->CaptureWindow(1)
                                                                 : layout->CaptureWindow(1));
  if (!picture) return false;
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(picture);
  writer->SetFileName(file.toUtf8().constData());
  writer->Write();
  return writer->GetErrorCode() == 0;
}

}  // namespace palpate::plugin
