#pragma once

/// The clinician's layout: axial, coronal and sagittal slices and the volume, of one scan.

#include <QPointer>

#include <functional>
#include <memory>
#include <vector>

#include "plugin/paraview/client/views/image_lattice.h"
#include "plugin/paraview/client/views/orientation_marker.h"
#include "plugin/paraview/client/views/slice_view.h"

class pqPipelineSource;
class vtkSMSourceProxy;

namespace palpate::plugin {

enum class ViewKind { axial, sagittal, coronal, volume };
struct ClinicalView {
  ViewKind kind = ViewKind::volume;
  pqRenderView* view = nullptr;
};

/// The clinical views among all that are open, by their names: also those that a state file has restored.
std::vector<ClinicalView> find_clinical_views();

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
  /// How places under the pointer are written from now on.
  void set_coordinates(Coordinates coordinates) { window_->coordinates = coordinates; }
  /// Gets the left button in the slices from now on; empty: it sets the window again.
  void set_pick(std::function<void(Pick, const glm::dvec3&)> pick) { window_->pick = std::move(pick); }

  /// Those that are open, the slices first.
  std::vector<ClinicalView> views() const;
  /// Moves every slice view to the slice nearest to a place in the patient, mm. Cheap where none changes.
  void show_point(const glm::dvec3& place);

 private:
  void prepare(vtkSMSourceProxy& image, const ImageLattice& lattice);
  void add_slice(const ImageLattice& lattice, Plane plane, ViewKind kind, pqRenderView& view, vtkSMProxy& shown,
                 int slice, bool restored);
  void add_volume(pqRenderView& volume_view);
  void refresh();

  std::shared_ptr<SharedWindow> window_ = std::make_shared<SharedWindow>();
  std::vector<NamedWindow> windows_;
  std::vector<QPointer<SliceView>> slices_;
  std::unique_ptr<OrientationMarker> marker_;  ///< of the volume's view; before that goes
  struct OpenView {
    ViewKind kind;
    QPointer<pqRenderView> view;
  };
  std::vector<OpenView> views_;
  QObject lifetime_;  // its end ends what is connected to the views
};

}  // namespace palpate::plugin
