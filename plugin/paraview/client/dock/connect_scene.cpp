#include <pqApplicationCore.h>
#include <pqServerManagerModel.h>

#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/panel/curves_section.h"
#include "plugin/paraview/client/panel/profile_section.h"
#include "plugin/paraview/client/panel/tissues_section.h"

// Connections for edits of the scene, which the views follow, and for the place under the pointer.

namespace palpate::plugin {

void PanelParts::connect_scene() {
  // What keeps scene and marks was deleted in the Pipeline Browser, and the scan is still there.
  const auto reopen = [this] {
    if (!kept.is_open() && readers.source() && scans.shown()) model.reopen();
  };
  QObject::connect(pqApplicationCore::instance()->getServerManagerModel(), &pqServerManagerModel::sourceRemoved, &dock,
                   reopen, Qt::QueuedConnection);
  QObject::connect(&model, &SceneModel::changed, &dock, [this](Pace pace) { layers.draw_boundaries(pace); });
  QObject::connect(column->tissues, &TissuesSection::scene_kept, &dock, [this] { unsaved.note_scene_saved(); });
  QObject::connect(column, &Column::boundaries_wanted, &dock, [this](bool on) { layers.boundaries.set_visible(on); });
  QObject::connect(column, &Column::crosshair_wanted, &dock, [this](bool on) { layers.crosshair.set_visible(on); });
  QObject::connect(column->profile, &ProfileSection::picking, &dock, [this](bool on) {
    session.keep_mouse_off(on);
    if (on) looks.read_opacity();  // it may have been edited in ParaView since
    strokes->give_to_profile(on);
  });
  QObject::connect(column->profile, &ProfileSection::stroke_changed, &dock,
                   [this](const WantedStroke& stroke) { column->curves->profile().choose(stroke); });
  readers.views().set_pointed([this](const std::optional<glm::dvec3>& place) {
    const std::optional<io::Sample> pointed = place ? layers.boundaries.sample(*place) : std::nullopt;
    column->curves->mark(pointed);
    strokes->show_brush(place);
    if (pointed) column->curves->profile().point_at(*place, pointed->gradient);
  });
  readers.views().set_slice_shown([this](SliceView& slice) {
    open_views.show_slice(slice);
    strokes->follow_slice(slice);
  });
}

}  // namespace palpate::plugin
