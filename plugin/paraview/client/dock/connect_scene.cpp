#include <pqApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <vtkSMProxy.h>

#include <QPointer>
#include <QTimer>

#include <string>
#include <variant>

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
  auto* const pipeline = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(pipeline, &pqServerManagerModel::sourceRemoved, &dock, reopen, Qt::QueuedConnection);
  QObject::connect(pipeline, &pqServerManagerModel::sourceAdded, &dock, [this](pqPipelineSource* source) {
    QTimer::singleShot(0, &dock, [this, source = QPointer(source)] {
      if (source) adopt_undone(*source);
    });
  });
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

/// What keeps scene and marks was deleted with its scan, and undo brings both back. Of a state file, adopt_state()
/// takes it over.
void PanelParts::adopt_undone(pqPipelineSource& added) {
  const bool is_scene = added.getProxy() && added.getProxy()->GetXMLName() == std::string("PalpateScene");
  if (!is_scene || kept.is_open() || pqApplicationCore::instance()->isLoadingState()) return;
  const auto* const fetching = std::get_if<in_views::Fetching>(&scans.in_views());
  const bool is_undone = fetching && fetching->brought == Brought::by_undo;
  if (is_undone || std::holds_alternative<in_views::Lost>(scans.in_views())) kept.replace(&added);
}

}  // namespace palpate::plugin
