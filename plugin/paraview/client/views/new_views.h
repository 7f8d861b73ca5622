#pragma once

/// Makes a scan's views from ParaView's own: views, layout and representations.

#include <glm/vec3.hpp>

class pqPipelineSource;
class pqRenderView;
class pqServer;
class vtkSMProxy;
class vtkSMSourceProxy;
class vtkSMViewLayoutProxy;

namespace palpate::plugin {

/// Black and without axes. A flat view is panned, not rotated.
pqRenderView* make_view(pqServer& server, bool flat);
/// An empty tab.
vtkSMViewLayoutProxy& make_layout(pqServer& server);
void remove_layout(vtkSMViewLayoutProxy& layout);
/// Shows an image, colored by an array of its points, without a scalar bar.
vtkSMProxy& show_as(const char* representation, vtkSMSourceProxy& image, pqRenderView& view, const char* array);
/// From the front and a little from the patient's left and above; the head up. `center` in patient space, mm.
void look_from_the_front(const pqRenderView& view, const glm::dvec3& center);
/// Makes a trace show the scan in a view of ParaView's own: the clinical views are the panel's, which is missing when a
/// trace is replayed.
void trace_shown(pqPipelineSource& source);

}  // namespace palpate::plugin
