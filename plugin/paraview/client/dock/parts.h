#pragma once

/// The panel's parts and the connections between them. Each part has a file in this folder; a connection is in the file
/// of the part that sends the signal.

#include <QCoreApplication>
#include <QDockWidget>
#include <QMainWindow>

#include <functional>
#include <memory>
#include <optional>

#include "plugin/paraview/client/dock/column.h"
#include "plugin/paraview/client/dock/drawn_layers.h"
#include "plugin/paraview/client/dock/outline_strokes.h"
#include "plugin/paraview/client/dock/unsaved_guard.h"
#include "plugin/paraview/client/dock/volume_looks.h"
#include "plugin/paraview/client/model/correction_model.h"
#include "plugin/paraview/client/model/marks_model.h"
#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/model/scan_model.h"
#include "plugin/paraview/client/model/scene_model.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/model/sharing_model.h"
#include "plugin/paraview/client/model/unsaved_work.h"
#include "plugin/paraview/client/panel/send_dialog.h"
#include "plugin/paraview/client/pipeline/scan_pipeline.h"
#include "plugin/paraview/client/pipeline/scene_source.h"
#include "plugin/paraview/client/remote/server_structures.h"
#include "plugin/paraview/client/remote/server_watch.h"

namespace palpate::plugin {

class ClinicalToolbar;
class HostLayout;
struct CorrectedOutline;

/// Members in order of dependence.
struct PanelParts {
  Q_DECLARE_TR_FUNCTIONS(PanelParts)

 public:
  /// `window`: ParaView's.
  PanelParts(QDockWidget& panel, QMainWindow& window)
      : dock(panel),
        session(model, &panel),
        layers(open_views, session, model, marks),
        looks(readers, layers, kept, &window),
        guard(unsaved, scans, window) {}

  void build();
  // build_toolbar.cpp
  void build_toolbar();
  void ask_picture();
  void enlarge(bool enlarged);
  // connect_scan.cpp
  void connect_scan();
  void show_scan(const ScanHandle& handle, Brought brought);
  void show_frame(const ScanHandle& handle);
  void note_scan(const ScanHandle& handle);
  void adopt_state();
  void leave(const QString& why);
  void leave_server();
  void leave_views();
  // connect_start.cpp
  void connect_start();
  // connect_structures.cpp
  void show_structures(const ScanHandle& handle);
  void leave_structures();
  // connect_correction.cpp
  void connect_correction();
  void draw_felt(const MarkMade& made);
  void save_outline();
  void send_outline();
  std::optional<CorrectedOutline> corrected_outline();
  // choose_archive.cpp
  std::optional<io::Archive> choose_archive(const io::Series& of, const SendDialog::Content& content,
                                            const std::function<void(const QString&)>& tell_problem);
  // connect_marks.cpp
  void connect_marks();
  void show_marks(const ScanHandle& handle);
  void leave_marks();
  void send_marks();
  // connect_scene.cpp
  void connect_scene();
  void adopt_undone(pqPipelineSource& added);
  // connect_session.cpp
  void connect_session();
  void follow_stylus(const SessionStatus& seen, bool moved);
  void name_felt();
  glm::dvec3 start_of(const device::Specification& stylus);

  QDockWidget& dock;
  OpenViews open_views;
  SceneSource kept;
  SceneModel model{kept};
  MarksModel marks{kept};
  UnsavedWork unsaved{model, marks};
  CorrectionModel correction{model};
  SessionController session;
  SharingModel sharing{session, model, marks};
  DrawnLayers layers;
  ServerWatch servers;
  ServerStructures served;
  ScanPipeline readers;
  ScanModel scans{readers};
  VolumeLooks looks;
  UnsavedGuard guard;
  Column* column = nullptr;
  std::unique_ptr<OutlineStrokes> strokes;
  ClinicalToolbar* toolbar = nullptr;
  HostLayout* layout = nullptr;
};

}  // namespace palpate::plugin
