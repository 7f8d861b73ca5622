#pragma once

/// A scroll bar at the right edge of a slice view. It is drawn in the view, because a view may be a native window,
/// which no widget can cover.

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include "plugin/paraview/client/views/event_watch.h"

class vtkActor2D;
class vtkPVRenderView;
class vtkPoints;
class vtkRenderer;

namespace palpate::plugin {

class SliceScrollBar {
 public:
  explicit SliceScrollBar(vtkPVRenderView& view);
  SliceScrollBar(const SliceScrollBar&) = delete;
  SliceScrollBar& operator=(const SliceScrollBar&) = delete;
  ~SliceScrollBar();

  /// Sets the slice that is shown, `n` from 0, and the number of slices. Slices count from the bottom.
  void set(int n, int of);
  void set_visible(bool visible);
  /// Whether a position in the view, in pixels from the left, is on it.
  bool is_under(int x) const;
  /// The position of `y` within the range of the handle, 0 to 1; `y` in pixels from below.
  double part_at(int y) const;

 private:
  int width() const;
  double handle_height() const;
  void place();

  vtkSmartPointer<vtkRenderer> renderer_;
  vtkNew<vtkPoints> track_points_, handle_points_;
  vtkNew<vtkActor2D> track_, handle_;
  int n_ = 0, of_ = 1;
  EventWatch before_render_;
};

}  // namespace palpate::plugin
