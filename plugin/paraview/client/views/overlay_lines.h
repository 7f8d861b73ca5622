#pragma once

/// Lines of one color in front of a slice view.

#include <pqRenderView.h>
#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>

#include <QPointer>

#include <array>

#include "plugin/paraview/client/views/clinical_views.h"
#include "plugin/paraview/client/views/overlay_layer.h"

namespace palpate::plugin {

/// Not visible at first; cannot be picked.
struct OverlayLines {
  OverlayLines(const ClinicalView& of, const std::array<double, 3>& color);

  QPointer<SliceView> slice;
  QPointer<pqRenderView> view;
  OverlayLayer layer;
  vtkNew<vtkPolyData> lines;
  vtkNew<vtkActor> actor;
};

}  // namespace palpate::plugin
