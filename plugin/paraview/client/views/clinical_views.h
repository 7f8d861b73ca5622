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

  /// Is told that the views are there, or with an error, in words, that they are not.
  using Shown = std::function<void(const std::string& error)>;
  /// Makes the views of an image in a layout of their own, the first slices in the middle: one after the other, each in
  /// a turn of the event loop of its own. The source has to be up to date. close() ends it; nothing is told then.
  void show(pqPipelineSource& source, Shown shown);
  /// To be called before the source is made: the empty view of a fresh session, unseen yet, would be drawn first.
  void make_room();
  /// What is still to be made is not made: what was to be shown is gone, or has views already.
  void stop_making();
  /// The same where the session goes that all is in: what is held of its scan goes, and the views go with it.
  void let_go();
  /// ParaView handles events while it makes a view, and nothing is to be closed then: this is done at once, or after
  /// the view that is being made. Of several that wait for it, the last is done.
  void alone(std::function<void()> step) { turns_.alone(std::move(step)); }
  /// Called when the views begin to be made, and when they are all there, or will not be.
  void set_making_changed(std::function<void(bool)> changed) { making_changed_ = std::move(changed); }
  /// Takes over existing clinical views of an image, which a state file has restored.
  void adopt(pqPipelineSource& source);
  /// Removes the views of the layout that was shown last.
  void close();
  /// Removes their tab, too, where nothing else stands in it.
  void drop_layout();
  void set_window(const Window& window);
  const Window& window() const { return window_->window; }
  /// The windows offered for the scan that is shown, the first one first; empty if no scan is shown.
  const std::vector<NamedWindow>& windows() const { return windows_; }
  /// The looks offered for the volume, and which of them it was first shown with. None: a state file has restored the
  /// volume with a look of somebody's own.
  const std::vector<VolumeLook>& looks() const { return looks_; }
  std::optional<std::size_t> first_look() const { return first_look_; }
  /// How places under the pointer are written from now on.
  void set_coordinates(Coordinates coordinates) { window_->coordinates = coordinates; }
  /// Handles the left button in the slices from now on; empty: the button sets the window again.
  void set_pick(std::function<void(Pick, const glm::dvec3&)> pick) { window_->pick = std::move(pick); }

  /// What the next drag in a slice measures.
  void set_measure(Measure measure);
  /// Called when another measure is chosen, or none, also after something was measured.
  void set_measure_changed(std::function<void(Measure)> changed) { measure_changed_ = std::move(changed); }
  /// What the corners of the slices tell of the scan; set after show().
  void set_scan_texts(const QString& identity, double thickness_mm);
  void set_frame_text(const QString& frame);

  /// What is cut away from the volume; null before a scan is shown.
  PatientVolume* patient() const { return patient_.get(); }
  /// Called when what can be cut away changes.
  void set_patient_changed(std::function<void()> changed) { patient_changed_ = std::move(changed); }

  /// Those that are open, the slices first.
  std::vector<ClinicalView> views() const;
  /// Moves every slice view to the slice nearest to a place in the patient, mm. Cheap where none changes.
  /// One whose slices have the normal `but` stays.
  void show_point(const glm::dvec3& place, const std::optional<glm::dvec3>& but = {});
  /// Called when the user leafs through slices.
  void set_leafed(std::function<void()> leafed) { window_->leafed = std::move(leafed); }
  /// Called with the place under the pointer in a slice when that has moved; with none when it has left.
  void set_pointed(std::function<void(const std::optional<glm::dvec3>&)> pointed) {
    window_->pointed = std::move(pointed);
  }
  /// Called when the window is another one, whoever has changed it.
  void set_window_changed(std::function<void()> changed) { window_changed_ = std::move(changed); }
  /// Called when a double click has enlarged a view, or brought it back; and when all stand beside each other anew.
  void set_enlarged_changed(std::function<void(bool)> changed) { enlarged_changed_ = std::move(changed); }
  /// Called when a slice view shows another slice.
  void set_slice_shown(std::function<void(SliceView&)> shown) { window_->slice_shown = std::move(shown); }
  /// Another frame is shown: what is told of the place under the pointer follows.
  void refresh_values();
  /// The same, read completely: windows and looks are offered anew for its values. The window that was one of those
  /// offered before becomes the frame's own of that name; speeds keep theirs, which are to be compared.
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
  std::unique_ptr<OrientationMarker> marker_;  ///< of the volume's view; before that goes
  std::shared_ptr<PatientVolume> patient_;     ///< the same
  struct OpenView {
    ViewKind kind;
    QPointer<pqRenderView> view;
    QPointer<SliceView> slice;
    std::unique_ptr<DoubleClickEnlarges> enlarges;
    std::unique_ptr<ViewMark> mark;
  };
  std::vector<OpenView> views_;
  vtkWeakPointer<vtkSMViewLayoutProxy> layout_;  ///< the tab that the scan is shown in, used again for the next
  QObject lifetime_;                             // its end ends what is connected to the views
  std::shared_ptr<Making> making_;               // while the views are made
  Turns turns_;
};

}  // namespace palpate::plugin
