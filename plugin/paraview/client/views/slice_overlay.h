#pragma once

/// The text over a slice.

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <QString>

#include <array>

class vtkCallbackCommand;
class vtkPVRenderView;
class vtkRenderer;
class vtkTextActor;

namespace palpate::plugin {

/// Letters at the four edges, which follow the camera; what is shown in the upper left corner, what is
/// under the pointer below it.
/// Whether a place of a view (0 to 1, from the left and from below) is away from its edges and from all texts.
bool is_clear_of_texts(double x, double y);

class SliceOverlay {
 public:
  explicit SliceOverlay(vtkPVRenderView& view);
  SliceOverlay(const SliceOverlay&) = delete;
  SliceOverlay& operator=(const SliceOverlay&) = delete;
  ~SliceOverlay();

  void set_corner(const QString& text);
  /// Whether it is another text than before.
  bool set_pointer(const QString& text);

 private:
  void update_letters();

  vtkSmartPointer<vtkRenderer> renderer_;
  vtkPVRenderView& view_;
  std::array<vtkNew<vtkTextActor>, 6> texts_;  // right, left, top, bottom; corner, pointer
  QString pointer_;
  vtkNew<vtkCallbackCommand> before_render_;
  unsigned long observer_ = 0;
};

}  // namespace palpate::plugin
