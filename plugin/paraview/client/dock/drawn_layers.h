#pragma once

/// What is drawn in the views over the scan: boundaries, flow, crosshair, marks, the stylus.

#include <QTimer>

#include "plugin/paraview/client/jobs/free_memory.h"
#include "plugin/paraview/client/model/marks_model.h"
#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/stylus/stylus_views.h"
#include "plugin/paraview/client/views/boundary_contours.h"
#include "plugin/paraview/client/views/drawing_watch.h"
#include "plugin/paraview/client/views/flow_views.h"
#include "plugin/paraview/client/views/mark_views.h"
#include "plugin/paraview/client/views/reference_lines.h"

namespace palpate::plugin {

class DrawnLayers {
 public:
  DrawnLayers(OpenViews& views, SessionController& session, SceneModel& scene, const MarksModel& marks);
  DrawnLayers(const DrawnLayers&) = delete;
  DrawnLayers& operator=(const DrawnLayers&) = delete;

  /// The boundaries of the scene as it is felt.
  void draw_boundaries(Pace pace = Pace::stepped);
  /// The scan goes: nothing of it is held.
  void forget_scan();
  /// The stylus where it was last; goes on by itself while a picture comes in turns.
  void draw_stylus();
  /// True: nothing is drawn. What is drawn while a server is left would ask a server that may be lost, and ParaView
  /// then ends the program.
  void pause(bool on) { paused_ = on; }
  bool is_paused() const { return paused_; }

  FlowViews flow;
  BoundaryContours boundaries;
  ReferenceLines crosshair;
  MarkViews marks;
  StylusViews stylus;
  FreeMemory memory;

 private:
  SessionController& session_;
  SceneModel& scene_;
  DrawingWatch watch_;
  QTimer next_turn_;  // of a picture that comes in turns
  bool paused_ = false;
};

}  // namespace palpate::plugin
