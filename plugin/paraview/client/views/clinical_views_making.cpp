#include "plugin/paraview/client/views/clinical_views_making.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqObjectBuilder.h>
#include <pqServer.h>
#include <pqUndoStack.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMTrace.h>

#include <QCoreApplication>

#include <iterator>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/views/new_views.h"
#include "plugin/paraview/client/views/slice_setup.h"

// A scan's views are made one after the other, each in its own turn of the event loop.

namespace palpate::plugin {
namespace {

constexpr int volume_cell = 6;

QString name_of(ViewKind kind) {
  const auto translated = [](const char* text) { return QCoreApplication::translate("ClinicalViews", text); };
  switch (kind) {
    case ViewKind::axial:
      return translated("Axial");
    case ViewKind::sagittal:
      return translated("Sagittal");
    case ViewKind::coronal:
      return translated("Coronal");
    case ViewKind::volume:
      break;
  }
  return translated("Volume");
}

}  // namespace

/// Empty: the tab of the scan before, a fresh session's with its one empty view, or a new one where views of the user's
/// own stand in it.
vtkSMViewLayoutProxy& ClinicalViews::take_layout(pqServer& server) {
  auto* const builder = pqApplicationCore::instance()->getObjectBuilder();
  vtkSMViewLayoutProxy* layout = layout_ ? layout_.Get() : pqActiveObjects::instance().activeLayout();
  if (layout && layout->GetViews().size() == 1 && !layout_) {
    auto* const old = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
    if (old && old->getNumberOfVisibleRepresentations() == 0) builder->destroy(old);
  }
  if (!layout || layout->GetSession() != server.session() || !layout->GetViews().empty()) {
    layout = &make_layout(server);
  }
  layout->Reset();
  layout_ = layout;
  return *layout;
}

void ClinicalViews::add_step(const std::function<void(Making&)>& step) {
  turns_.add([this, step] {
    const auto making = making_;  // a server that is lost within the step ends it
    if (!making->is_there()) throw Refusal(say("scan-left-the-pipeline"));
    SCOPED_UNDO_EXCLUDE();  // undo is for what is edited
    SM_SCOPED_TRACE(BlockTraceItems);
    step(*making);
  });
}

/// Asked after what may handle events.
bool ClinicalViews::goes_on(const Making& making) const {
  return making_.get() == &making && making.is_there();
}

void ClinicalViews::show(pqPipelineSource& source, Shown shown) {
  close();
  trace_shown(source);
  making_ = std::make_shared<Making>();
  making_->source = &source;
  making_->shown = std::move(shown);
  if (making_changed_) making_changed_(true);
  add_step([this](Making& making) { begin_layout(making); });
  for (std::size_t place = 0; place < std::size(slice_places); ++place) {
    add_step([this, place](Making& making) { make_slice_view(making, place); });
    add_step([this, place](Making& making) { fill_slice_view(making, place); });
  }
  add_step([this](Making& making) { make_volume_view(making); });
  add_step([this](Making& making) { fill_volume_view(making); });
  add_step([this](Making& making) { finish(making); });
}

void ClinicalViews::begin_layout(Making& making) {
  making.lattice = lattice_of(making.image());
  making.layout = &take_layout(*making.source->getServer());
  making.has_layout = true;
  making.layout->SplitHorizontal(0, 0.5);
  making.layout->SplitVertical(1, 0.5);
  making.layout->SplitVertical(2, 0.5);
  prepare(making.image(), making.lattice);
  window_->window = windows_.front().window;
  plugin::set_window(*window_->gray_map, window_->window);
  name_window();
}

void ClinicalViews::make_slice_view(Making& making, std::size_t place) {
  making.view = make_view(*making.source->getServer(), true);
  if (!goes_on(making) || !making.view) return;
  making.layout->AssignView(slice_places[place].cell, making.view->getViewProxy());
}

void ClinicalViews::fill_slice_view(Making& making, std::size_t place) {
  if (!making.view) return;
  const auto& [plane, kind, cell] = slice_places[place];
  const ImageLattice& lattice = making.lattice;
  vtkSMProxy& shown = show_as("Slice", making.image(), *making.view, lattice.array.c_str());
  if (!goes_on(making) || !making.view) return;
  const Sight sight = sight_of(plane, lattice.directions);
  vtkSMPropertyHelper(&shown, "SliceMode").Set(slice_mode(sight));
  vtkSMPropertyHelper(&shown, "LookupTable").Set(window_->gray_map);
  vtkSMPropertyHelper(&shown, "ScalarOpacityFunction")
      .Set(vtkSMPropertyHelper(window_->gray_map, "ScalarOpacityFunction").GetAsProxy());
  shown.UpdateVTKObjects();
  add_slice(lattice, plane, kind, *making.view, shown, lattice.dimensions[sight.index_axis] / 2, false);
  making.view.clear();
}

void ClinicalViews::make_volume_view(Making& making) {
  making.view = make_view(*making.source->getServer(), false);
  if (!goes_on(making) || !making.view) return;
  making.layout->AssignView(volume_cell, making.view->getViewProxy());
}

void ClinicalViews::fill_volume_view(Making& making) {
  if (!making.view) return;
  vtkSMProxy& volume = show_as("Volume", making.image(), *making.view, making.lattice.array.c_str());
  if (!goes_on(making) || !making.view) return;
  first_look_ = suited_look(making.lattice.values);
  set_volume_look(volume, looks_.at(*first_look_));
  look_from_the_front(*making.view, making.lattice.center());
  add_volume(*making.view, *making.source);
  making.view.clear();
}

void ClinicalViews::finish(Making& making) {
  // Not before all are there: the next would have this one's first name again.
  for (const auto& open : views_) {
    if (open.view) open.view->rename(name_of(open.kind));
  }
  refresh();
  if (enlarged_changed_) enlarged_changed_(false);
  const Shown shown = making.shown;
  stop_making();
  turns_.add([shown] { shown({}); });
}

}  // namespace palpate::plugin
