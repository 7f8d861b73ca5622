#pragma once

/// Coloring by an array: ParaView 5.11's representation proxy does this itself, 5.13 has a helper class for it.

#include <vtkPVVersion.h>
#include <vtkSMPVRepresentationProxy.h>
#if PARAVIEW_VERSION_NUMBER >= PARAVIEW_VERSION_CHECK(5, 13, 0)
#include <vtkSMColorMapEditorHelper.h>
#endif

namespace palpate::plugin {

/// Colors a representation by an array of its points.
inline void color_by_points(vtkSMPVRepresentationProxy& shown, const char* array) {
#if PARAVIEW_VERSION_NUMBER >= PARAVIEW_VERSION_CHECK(5, 13, 0)
  vtkSMColorMapEditorHelper::SetScalarColoring(&shown, array, 0);
#else
  shown.SetScalarColoring(array, 0);
#endif
}

inline void hide_scalar_bar(vtkSMPVRepresentationProxy& shown, vtkSMProxy& view) {
#if PARAVIEW_VERSION_NUMBER >= PARAVIEW_VERSION_CHECK(5, 13, 0)
  vtkSMColorMapEditorHelper::SetScalarBarVisibility(&shown, &view, false);
#else
  shown.SetScalarBarVisibility(&view, false);
#endif
}

}  // namespace palpate::plugin
