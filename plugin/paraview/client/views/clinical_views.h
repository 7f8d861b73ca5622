#pragma once

/// The clinician's layout: axial, coronal and sagittal slices and the volume, of one scan.

#include <vtkWeakPointer.h>

#include <QPointer>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "plugin/paraview/client/layout/enlarged_view.h"
#include "plugin/paraview/client/layout/view_mark.h"
#include "plugin/paraview/client/views/image_lattice.h"
#include "plugin/paraview/client/views/orientation_marker.h"
#include "plugin/paraview/client/views/slice_view.h"

class pqPipelineSource;
class pqServer;
class vtkSMSourceProxy;
class vtkSMViewLayoutProxy;

namespace palpate::plugin {

enum class ViewKind { axial, sagittal, coronal, volume };
struct ClinicalView {
  ViewKind kind = ViewKind::volume;
  pqRenderView* view = nullptr;
  SliceView* slice = nullptr;  ///< null: the volume's. Goes with the view
};

class ClinicalViews {
 public:
  ClinicalViews() = default;
  ClinicalViews(const ClinicalViews&) = delete;
  ClinicalViews& operator=(const ClinicalViews&) = delete;
  ~ClinicalViews();

  /// Shows an image in a layout of its own, the first slices in the middle. The source has to be up to date.
  void show(pqPipelineSource& source);
  /// Takes over the clinical views of an image as they stand: a state file has restored them.
  void adopt(pqPipelineSource& source);
  /// Views of the layout shown last are taken away again.
  void close();
  void set_window(const Window& window);
  const Window& window() const { return window_->window; }
  /// What is offered for the scan shown, the one that it is first shown with first; empty where none is.
  const std::vector<NamedWindow>& windows() const { return windows_; }
  /// What is offered for the volume, and which of them it was first shown with; empty where a state file has restored
  /// it.
  const std::vector<VolumeLook>& looks() const { return looks_; }
  std::optional<std::size_t> first_look() const { return first_look_; }
  /// How places under the pointer are written from now on.
  void set_coordinates(Coordinates coordinates) { window_->coordinates = coordinates; }
  /// Gets the left button in the slices from now on; empty: it sets the window again.
  void set_pick(std::function<void(Pick, const glm::dvec3&)> pick) { window_->pick = std::move(pick); }

  /// Those that are open, the slices first.
  std::vector<ClinicalView> views() const;
  /// Moves every slice view to the slice nearest to a place in the patient, mm. Cheap where none changes.
  void show_point(const glm::dvec3& place);
  /// Called when the user leafs through slices.
  void set_leafed(std::function<void()> leafed) { window_->leafed = std::move(leafed); }
  /// Called when the window is another one, whoever has changed it.
  void set_window_changed(std::function<void()> changed) { window_changed_ = std::move(changed); }
  /// Called when a double click has enlarged a view, or brought it back; and when all stand beside each other anew.
  void set_enlarged_changed(std::function<void(bool)> changed) { enlarged_changed_ = std::move(changed); }
  /// Called when a slice view shows another slice.
  void set_slice_shown(std::function<void(SliceView&)> shown) { window_->slice_shown = std::move(shown); }
  /// Another frame is shown: what is told of the place under the pointer follows.
  void refresh_values();

 private:
  vtkSMViewLayoutProxy& take_layout(pqServer& server);
  void prepare(vtkSMSourceProxy& image, const ImageLattice& lattice);
  void add_slice(const ImageLattice& lattice, Plane plane, ViewKind kind, pqRenderView& view, vtkSMProxy& shown,
                 int slice, bool restored);
  void add_volume(pqRenderView& volume_view);
  void refresh();
  std::unique_ptr<DoubleClickEnlarges> enlarging(pqRenderView& view);

  std::shared_ptr<SharedWindow> window_ = std::make_shared<SharedWindow>();
  std::function<void()> window_changed_;
  std::function<void(bool)> enlarged_changed_;
  std::vector<NamedWindow> windows_;
  std::vector<VolumeLook> looks_;
  std::optional<std::size_t> first_look_;
  std::vector<QPointer<SliceView>> slices_;
  std::unique_ptr<OrientationMarker> marker_;  ///< of the volume's view; before that goes
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
};

}  // namespace palpate::plugin
