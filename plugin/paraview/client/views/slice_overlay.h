#pragma once

/// The texts over a slice.

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <QString>

#include <array>
#include <functional>

#include "plugin/paraview/client/views/event_watch.h"

class vtkPVRenderView;
class vtkRenderer;
class vtkTextActor;

namespace palpate::plugin {

/// Whether a place of a view (0 to 1, from the left and from below) is away from its edges and from all texts.
bool is_clear_of_texts(double x, double y);

/// Letters at the four edges, which follow the camera. Upper left: the series and window. Lower left: the place under
/// the pointer. Upper right: patient and date. Lower right: the slice's position and magnification.
class SliceOverlay {
 public:
  /// `before_drawing` is called before each picture, with the picture's height in pixels.
  SliceOverlay(vtkPVRenderView& view, std::function<void(int height)> before_drawing);
  SliceOverlay(const SliceOverlay&) = delete;
  SliceOverlay& operator=(const SliceOverlay&) = delete;
  ~SliceOverlay();

  void set_corner(const QString& text);
  void set_identity(const QString& text);
  /// A line that is wider than the view is shortened in its middle.
  void set_place(const QString& text);
  /// Shows or hides all texts except the letters, which tell left from right.
  void set_texts_visible(bool visible);
  /// Shows or hides the patient's identity, which is not in saved pictures.
  void set_identity_visible(bool visible);
  /// Returns whether the text has changed.
  bool set_pointer(const QString& text);

 private:
  void update_letters();

  vtkSmartPointer<vtkRenderer> renderer_;
  vtkPVRenderView& view_;
  std::function<void(int)> before_drawing_;
  std::array<vtkNew<vtkTextActor>, 8> texts_;  // right, left, top, bottom; corner, pointer, identity, place
  QString pointer_, place_;
  int place_pixels_ = 0;
  EventWatch before_render_;
};

}  // namespace palpate::plugin
