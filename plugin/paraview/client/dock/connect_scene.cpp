#include <pqDataRepresentation.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <pqUndoStack.h>
#include <vtkSMProxy.h>

#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/panel/curves_section.h"
#include "plugin/paraview/client/panel/profile_section.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/paraview/client/views/volume_opacity.h"

// A scene is edited: the views follow.

namespace palpate::plugin {

void PanelParts::connect_scene() {
  QObject::connect(&model, &SceneModel::changed, &dock, [this](Pace pace) {
    if (const auto felt = touching.live().felt_scan(); felt && felt != studied.lock()) study(felt);
    draw_contours(pace);
  });
  QObject::connect(profile, &ProfileSection::picking, &dock, [this](bool on) {
    touching.keep_mouse_off(on);
    if (on) read_opacity();  // it may have been edited in ParaView since
    profile_picks = on;
    share_picks();
  });
  QObject::connect(profile, &ProfileSection::stroke_changed, &dock,
                   [this](const WantedStroke& stroke) { curves->profile().choose(stroke); });
  readers.views().set_pointed([this](const std::optional<glm::dvec3>& place) {
    const std::optional<io::Sample> pointed = place ? contours.sample(*place) : std::nullopt;
    curves->mark(pointed);
    show_brush(place);
    if (pointed) curves->profile().point_at(*place, pointed->gradient);
  });
  readers.views().set_slice_shown([this](SliceView& slice) {
    open_views.show_slice(slice);
    follow_held_slice(slice);
  });
}

void PanelParts::draw_contours(Pace pace) {
  contours.set_felt(touching.live().felt_scan(), model.scene(), touching.live().plan(), pace);
}

void PanelParts::change_volume(const std::function<void(vtkSMProxy&)>& change) {
  SCOPED_UNDO_EXCLUDE();  // follows from the scene, or from a box that says what it is
  if (!readers.source()) return;
  for (const ClinicalView& one : readers.views().views()) {
    if (one.kind != ViewKind::volume) continue;
    pqDataRepresentation* const shown = readers.source()->getRepresentation(one.view);
    if (!shown) continue;
    change(*shown->getProxy());
    one.view->render();
  }
  read_opacity();
}

/// A state file says so, too: nothing of ParaView's own does.
void PanelParts::show_felt(bool felt) {
  contours.set_surfaces(felt);
  kept.put(volume_look_key, felt ? felt_look : "");
}

/// What is seen of the volume, as it is shown now.
void PanelParts::read_opacity() {
  if (!readers.source()) return;
  for (const ClinicalView& one : readers.views().views()) {
    if (one.kind != ViewKind::volume) continue;
    if (pqDataRepresentation* const shown = readers.source()->getRepresentation(one.view)) {
      views.set_opacity(opacity_of(*shown->getProxy()));
    }
  }
}

}  // namespace palpate::plugin
