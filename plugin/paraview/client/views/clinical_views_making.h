#pragma once

/// For the implementation of ClinicalViews alone: the scan whose views are being made, and where they go.

#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMViewLayoutProxy.h>
#include <vtkWeakPointer.h>

#include <QPointer>

#include "plugin/paraview/client/views/clinical_views.h"

namespace palpate::plugin {

/// The slice view of each plane, and its cell in the layout.
struct SlicePlace {
  Plane plane;
  ViewKind kind;
  int cell;
};
inline constexpr SlicePlace slice_places[] = {{Plane::axial, ViewKind::axial, 3},
                                              {Plane::sagittal, ViewKind::sagittal, 5},
                                              {Plane::coronal, ViewKind::coronal, 4}};

struct ClinicalViews::Making {
  QPointer<pqPipelineSource> source;
  Shown shown;
  ImageLattice lattice;
  vtkWeakPointer<vtkSMViewLayoutProxy> layout;
  bool has_layout = false;
  QPointer<pqRenderView> view;  ///< made, and shows nothing yet

  /// Under *Advanced* the user can close tabs and views, and delete the scan, between two steps.
  bool is_there() const { return source && (!has_layout || layout); }
  vtkSMSourceProxy& image() const { return *vtkSMSourceProxy::SafeDownCast(source->getProxy()); }
};

}  // namespace palpate::plugin
