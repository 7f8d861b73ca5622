#pragma once

/// The clinician's layout: axial, coronal and sagittal slices and the volume, of one scan.

#include <vtkWeakPointer.h>

#include <QPointer>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/views/enlarged_view.h"
#include "plugin/paraview/client/views/image_lattice.h"
#include "plugin/paraview/client/views/orientation_marker.h"
#include "plugin/paraview/client/views/slice_view.h"
#include "plugin/paraview/client/views/turns.h"
#include "plugin/paraview/client/views/view_mark.h"

class pqPipelineSource;
class pqServer;
class vtkSMSourceProxy;
class vtkSMViewLayoutProxy;

namespace palpate::plugin {

class PatientVolume;

class ClinicalViews {
 public:
  ClinicalViews();
  ClinicalViews(const ClinicalViews&) = delete;
  ClinicalViews& operator=(const ClinicalViews&) = delete;
  ~ClinicalViews();

  /// Called when the views are complete, or with an error in words.
  using Shown = std::function<void(const std::string& error)>;
  /// Makes the views of an image in a layout of their own, with the middle slices: one view after the other, each in
  /// its own turn of the event loop. The source must be up to date. close() cancels it; then `shown` is not called.
  void show(pqPipelineSource& source, Shown shown);
  /// To be called before the source is made; otherwise the empty, hidden view of a fresh session would be drawn first.
  void make_room();
  /// Makes no more views, because the source has gone or already has views.
  void stop_making();
  /// The same at the end of the session: also releases everything of its scan; the views end with the session.
  void let_go();
  /// Runs the step at once, or after the view that is being made: ParaView handles events meanwhile, and nothing must
  /// be closed then. Of several waiting steps only the last is run.
  void alone(std::function<void()> step) { turns_.alone(std::move(step)); }
  /// Called when the making of views begins, and when it has ended, completely or not.
  void set_making_changed(std::function<void(bool)> changed) { making_changed_ = std::move(changed); }
  /// Takes over an image's clinical views, restored by a state file.
  void adopt(pqPipelineSource& source);
  /// Removes the views of the latest layout.
  void close();
  /// Also removes their tab if it contains nothing else.
  void drop_layout();
  void set_window(const Window& window);
  const Window& window() const { return window_->window; }
  /// The windows offered for the scan that is shown, the first one first; empty if no scan is shown.
  const std::vector<NamedWindow>& windows() const { return windows_; }
  /// The appearances offered for the volume, and the index of the first one used. None: a state file has restored the
  /// volume with an appearance of its own.
  const std::vector<VolumeLook>& looks() const { return looks_; }
  std::optional<std::size_t> first_look() const { return first_look_; }
  /// The notation of positions under the pointer.
  void set_coordinates(Coordinates coordinates) { window_->coordinates = coordinates; }
  /// `pick` gets the left button in the slices; empty: the button adjusts the window again.
  void set_pick(std::function<void(Pick, const glm::dvec3&)> pick) { window_->pick = std::move(pick); }

  /// The type of measurement that the next drag in a slice makes.
  void set_measure(Measure measure);
  /// Called when this type changes, also after a measurement.
  void set_measure_changed(std::function<void(Measure)> changed) { measure_changed_ = std::move(changed); }
  /// The texts about the scan in the corners of the slices; to be set after show().
  void set_scan_texts(const QString& identity, double thickness_mm);
  void set_frame_text(const QString& frame);

  /// Cuts table and surroundings away from the volume; null before a scan is shown.
  PatientVolume* patient() const { return patient_.get(); }
  /// Called when what can be cut away changes.
  void set_patient_changed(std::function<void()> changed) { patient_changed_ = std::move(changed); }

  /// The open views, the slices first.
  std::vector<ClinicalView> views() const;
  /// Moves every slice view to the slice nearest to a place in the patient, mm. Cheap if no slice changes. The view
  /// with the normal `but` is not moved.
  void show_point(const glm::dvec3& place, const std::optional<glm::dvec3>& but = {});
  /// Called when the user browses slices.
  void set_leafed(std::function<void()> leafed) { window_->leafed = std::move(leafed); }
  /// Called with the place under the pointer in a slice when it has moved, and with none when it has left.
  void set_pointed(std::function<void(const std::optional<glm::dvec3>&)> pointed) {
    window_->pointed = std::move(pointed);
  }
  /// Called when the window has changed, for any reason.
  void set_window_changed(std::function<void()> changed) { window_changed_ = std::move(changed); }
  /// Called when a double click has enlarged a view or restored it, and when all views are arranged again.
  void set_enlarged_changed(std::function<void(bool)> changed) { enlarged_changed_ = std::move(changed); }
  /// Called when a slice view shows another slice.
  void set_slice_shown(std::function<void(SliceView&)> shown) { window_->slice_shown = std::move(shown); }
  /// Another frame is shown: updates the text about the place under the pointer.
  void refresh_values();
  /// The same for a frame that was read completely: windows and appearances are offered for its values. If the present
  /// window is one of those offered before, it is replaced by the frame's own window of that name. For speeds nothing
  /// changes, so that frames can be compared.
  void show_frame_values(vtkSMSourceProxy& image);

 private:
  struct Making;
  void add_step(const std::function<void(Making&)>& step);
  bool goes_on(const Making& making) const;
  void begin_layout(Making& making);
  void make_slice_view(Making& making, std::size_t place);
  void fill_slice_view(Making& making, std::size_t place);
  void make_volume_view(Making& making);
  void fill_volume_view(Making& making);
  void finish(Making& making);
  vtkSMViewLayoutProxy& take_layout(pqServer& server);
  void prepare(vtkSMSourceProxy& image, const ImageLattice& lattice);
  void add_slice(const ImageLattice& lattice, Plane plane, ViewKind kind, pqRenderView& view, vtkSMProxy& shown,
                 int slice, bool restored);
  void add_volume(pqRenderView& volume_view, pqPipelineSource& source);
  void refresh();
  void name_window();
  std::unique_ptr<DoubleClickEnlarges> enlarging(pqRenderView& view);

  std::shared_ptr<SharedWindow> window_ = std::make_shared<SharedWindow>();
  std::function<void()> window_changed_;
  std::function<void(bool)> enlarged_changed_;
  std::function<void(Measure)> measure_changed_;
  std::function<void()> patient_changed_;
  std::function<void(bool)> making_changed_;
  std::vector<NamedWindow> windows_;
  std::vector<VolumeLook> looks_;
  std::optional<std::size_t> first_look_;
  std::vector<QPointer<SliceView>> slices_;
  std::unique_ptr<OrientationMarker> marker_;  ///< of the volume's view; must be destroyed before it
  std::shared_ptr<PatientVolume> patient_;     ///< likewise
  struct OpenView {
    ViewKind kind;
    QPointer<pqRenderView> view;
    QPointer<SliceView> slice;
    std::unique_ptr<DoubleClickEnlarges> enlarges;
    std::unique_ptr<ViewMark> mark;
  };
  std::vector<OpenView> views_;
  vtkWeakPointer<vtkSMViewLayoutProxy> layout_;  ///< the tab that the scan is shown in, used again for the next
  QObject lifetime_;                             // its destructor ends the connections to the views
  std::shared_ptr<Making> making_;               // while the views are made
  Turns turns_;
};

}  // namespace palpate::plugin
