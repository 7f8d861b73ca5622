#pragma once

/// The layers that are drawn over the scan in the views: boundaries, flow, crosshair, marks, the stylus.

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

  /// Draws the boundaries of the felt scene.
  void draw_boundaries(Pace pace = Pace::stepped);
  /// Releases everything that belongs to the scan.
  void forget_scan();
  /// Draws the stylus at its latest position; is called again while a picture is drawn in several turns.
  void draw_stylus();
  /// True: draws nothing. While a server is being left, drawing could send requests to a lost server, and ParaView
  /// would then end the program.
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
  QTimer next_turn_;  // of a picture that is drawn in several turns
  bool paused_ = false;
};

}  // namespace palpate::plugin
