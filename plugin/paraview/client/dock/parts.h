#pragma once

/// The panel's parts, and how each answers to the others. A file for each of them beside this one: a new connection
/// belongs to the file of what it starts from.

#include <QCoreApplication>
#include <QDockWidget>
#include <QTimer>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "plugin/paraview/client/jobs/free_memory.h"
#include "plugin/paraview/client/jobs/scan_loader.h"
#include "plugin/paraview/client/model/correction_model.h"
#include "plugin/paraview/client/model/marks_model.h"
#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/model/scan_model.h"
#include "plugin/paraview/client/model/scene_model.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/model/sharing_model.h"
#include "plugin/paraview/client/model/unsaved_work.h"
#include "plugin/paraview/client/panel/send_dialog.h"
#include "plugin/paraview/client/panel/stroke_runner.h"
#include "plugin/paraview/client/pipeline/scan_pipeline.h"
#include "plugin/paraview/client/pipeline/scene_source.h"
#include "plugin/paraview/client/remote/server_structures.h"
#include "plugin/paraview/client/remote/server_watch.h"
#include "plugin/paraview/client/stylus/stylus_views.h"
#include "plugin/paraview/client/views/boundary_contours.h"
#include "plugin/paraview/client/views/brush_views.h"
#include "plugin/paraview/client/views/drawing_watch.h"
#include "plugin/paraview/client/views/flow_views.h"
#include "plugin/paraview/client/views/mark_views.h"
#include "plugin/paraview/client/views/path_views.h"
#include "plugin/paraview/client/views/reference_lines.h"

class QProgressBar;
class vtkSMProxy;

namespace palpate::plugin {

class ClinicalToolbar;
class CurvesSection;
class FilterRow;
class Fold;
class Footer;
class HostLayout;
class MarksSection;
class ModesSection;
class ProfileSection;
class RecordingsSection;
class ScanSection;
class StructuresSection;
class StylusSection;
class TissuesSection;
class VolumeLookBox;
class WindowBox;
struct CorrectedOutline;

/// Of what the pipeline keeps beside scene and marks.
inline constexpr const char* volume_look_key = "VolumeLook";
inline constexpr const char* felt_look = "felt";

/// Members in the order in which they lean on each other.
struct PanelParts {
  Q_DECLARE_TR_FUNCTIONS(PanelParts)

 public:
  explicit PanelParts(QDockWidget& panel)
      : dock(panel),
        touching(model, &panel),
        strokes(touching),
        flow(open_views),
        contours(open_views),
        crosshair(open_views),
        drawn_stroke(open_views, QColor(255, 240, 80)),
        brush(open_views),
        drawn_marks(open_views, [this]() -> const Marks& { return marks.marks(); }),
        views(open_views, touching, model),
        drawing(open_views, [this](double seconds) { touching.note_work(tr("drawing"), seconds); }) {}

  void build();
  // build_column.cpp
  void build_column();
  QWidget* build_tissues();
  // build_toolbar.cpp
  void build_toolbar();
  void ask_picture();
  void enlarge(bool enlarged);
  // connect_scan.cpp
  void connect_scan();
  void show_scan(const ScanHandle& handle, Brought brought);
  void show_frame(const ScanHandle& handle);
  void note_scan(const ScanHandle& handle);
  void study(const std::shared_ptr<const io::Volume>& volume);
  void adopt_state();
  void leave(const QString& why);
  void leave_server();
  void leave_views();
  // connect_start.cpp
  void connect_start();
  // connect_structures.cpp
  void connect_structures();
  void show_structures(const ScanHandle& handle);
  void leave_structures();
  // connect_correction.cpp
  void connect_correction();
  void share_picks();
  void show_brush(const std::optional<glm::dvec3>& at);
  void draw_felt(const MarkMade& made);
  void save_outline();
  void send_outline();
  bool stroke_over_outline(Pick what, const glm::dvec3& near, const glm::dvec3& far);
  std::optional<HeldPlane> marked_slice() const;
  void follow_held_slice(const SliceView& shown);
  std::optional<CorrectedOutline> corrected_outline();
  // choose_archive.cpp
  std::optional<io::Archive> choose_archive(const io::Series& of, const SendDialog::Content& content,
                                            const std::function<void(const QString&)>& tell_problem);
  // connect_marks.cpp
  void connect_marks();
  void show_marks(const ScanHandle& handle);
  void leave_marks();
  void send_marks();
  // connect_unsaved.cpp
  void connect_unsaved();
  bool may_lose(const Unsaved& work, const QString& before, const std::function<void()>& let_go);
  bool save_state();
  bool write_state(const QString& file);
  QString recover();
  // connect_scene.cpp
  void connect_scene();
  void draw_contours(Pace pace = Pace::stepped);
  void show_frame_values();
  void change_volume(const std::function<void(vtkSMProxy&)>& change);
  void show_felt(bool felt);
  void read_opacity();
  // connect_session.cpp
  void connect_session();
  void look(const SessionStatus& seen);
  void draw_stylus();
  void name_felt();
  glm::dvec3 start_of(const device::Specification& stylus);

  QDockWidget& dock;
  OpenViews open_views;
  SceneSource kept;
  SceneModel model{kept};
  MarksModel marks{kept};
  UnsavedWork unsaved{model, marks};
  CorrectionModel correction{model};
  SessionController touching;
  StrokeRunner strokes;
  SharingModel sharing{touching, model, marks};
  FlowViews flow;
  BoundaryContours contours;
  ReferenceLines crosshair;
  PathViews drawn_stroke;
  BrushViews brush;
  MarkViews drawn_marks;
  StylusViews views;
  DrawingWatch drawing;
  FreeMemory memory;
  QTimer next_turn;  // of a picture that comes in turns
  ServerWatch servers;
  ServerStructures served;
  ScanPipeline readers;
  ScanModel scans{readers};
  Fold* scan_fold = nullptr;
  Fold* recordings_fold = nullptr;
  Footer* footer = nullptr;
  ScanSection* scan = nullptr;
  FilterRow* filter = nullptr;
  TissuesSection* tissues = nullptr;
  Fold* structures_fold = nullptr;
  StructuresSection* structures = nullptr;
  StylusSection* stylus = nullptr;
  Fold* marks_fold = nullptr;
  MarksSection* marks_list = nullptr;
  CurvesSection* curves = nullptr;
  ModesSection* modes = nullptr;
  ProfileSection* profile = nullptr;
  RecordingsSection* recordings = nullptr;
  QProgressBar* studying = nullptr;
  ClinicalToolbar* toolbar = nullptr;
  HostLayout* layout = nullptr;
  VolumeLookBox* look_box = nullptr;
  bool leaving = false;                     // a server
  bool ending = false;                      // the program
  bool saving = false;                      // a state file, which may fail
  bool profile_picks = false;               // the left button in the views is the force profile's
  QString opening;                          // whose scan is coming, in words
  std::weak_ptr<const io::Volume> studied;  // for its tissues
  std::uint64_t followed = 0;               // last tick of a recording that the slices followed
  ScanLoader studies;                       // last: its thread is to end before all that its callbacks use
};

}  // namespace palpate::plugin
