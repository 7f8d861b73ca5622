#include "plugin/paraview/client/layout/view_picture.h"

#include <pqApplicationCore.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSMViewLayoutProxy.h>
#include <vtkSmartPointer.h>

#include "plugin/paraview/client/views/enlarged_view.h"
#include "plugin/paraview/client/views/slice_view.h"

namespace palpate::plugin {

namespace {

void set_for_picture(bool for_picture) {
  for (auto* const view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>()) {
    for (QObject* const child : view->children()) {
      if (auto* const slice = dynamic_cast<SliceView*>(child)) slice->set_for_picture(for_picture);
    }
  }
}

}  // namespace

bool save_picture(pqRenderView& marked, const QString& file) {
  vtkSMViewLayoutProxy* const layout = layout_of(marked);
  const bool alone = !layout || is_enlarged(marked);
  set_for_picture(true);
  const auto picture = vtkSmartPointer<vtkImageData>::Take(alone ? marked.getRenderViewProxy()->CaptureWindow(1)
                                                                 : layout->CaptureWindow(1));
  set_for_picture(false);
  if (!picture) return false;
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(picture);
  writer->SetFileName(file.toUtf8().constData());
  writer->Write();
  return writer->GetErrorCode() == 0;
}

}  // namespace palpate::plugin
