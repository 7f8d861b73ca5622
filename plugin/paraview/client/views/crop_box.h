#pragma once

/// A box in the volume view with a handle on each side; everything outside is cut away.

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <QPointer>

class pqRenderView;
class vtkBoxRepresentation;
class vtkBoxWidget2;
class vtkCallbackCommand;
class vtkPlaneCollection;

namespace palpate::plugin {

class CropBox {
 public:
  /// Starts at these bounds: least and greatest x, y and z, patient space, mm.
  CropBox(pqRenderView& view, const double bounds[6]);
  CropBox(const CropBox&) = delete;
  CropBox& operator=(const CropBox&) = delete;
  ~CropBox();

  void set_visible(bool visible);
  /// Clipping planes for the cropped volume's mapper; they follow the handles.
  vtkPlaneCollection* planes() const { return planes_; }

 private:
  void follow();

  QPointer<pqRenderView> view_;
  vtkNew<vtkBoxRepresentation> shape_;
  vtkNew<vtkBoxWidget2> widget_;
  vtkNew<vtkPlaneCollection> planes_;
  vtkNew<vtkCallbackCommand> dragged_;
};

}  // namespace palpate::plugin
