#include "plugin/paraview/client/dock/volume_looks.h"

#include <pqDataRepresentation.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <pqUndoStack.h>
#include <vtkSMProxy.h>
#include <vtkSMSourceProxy.h>

#include <optional>

#include "plugin/paraview/client/dock/drawn_layers.h"
#include "plugin/paraview/client/layout/volume_look_box.h"
#include "plugin/paraview/client/model/kept_text.h"
#include "plugin/paraview/client/pipeline/scan_pipeline.h"
#include "plugin/paraview/client/views/color_maps.h"
#include "plugin/paraview/client/views/volume_opacity.h"

namespace palpate::plugin {
namespace {

// The key of this text in the pipeline, beside scene and marks.
constexpr const char* volume_look_key = "VolumeLook";
constexpr const char* felt_look = "felt";

}  // namespace

VolumeLooks::VolumeLooks(ScanPipeline& readers, DrawnLayers& layers, KeptText& kept, QWidget* parent)
    : readers_(readers), layers_(layers), kept_(kept), box_(new VolumeLookBox(parent)) {
  QObject::connect(box_, &VolumeLookBox::felt_chosen, &lifetime_, [this] { show_felt(true); });
  QObject::connect(box_, &VolumeLookBox::look_chosen, &lifetime_, [this](const VolumeLook& chosen) {
    show_felt(false);
    change([&](vtkSMProxy& volume) { set_volume_look(volume, chosen); });
  });
}

void VolumeLooks::begin_scan() {
  box_->set_looks(readers_.views().looks(), readers_.views().first_look());
}

void VolumeLooks::restore(bool restored) {
  const bool felt = restored && kept_.text(volume_look_key) == felt_look;
  if (felt) box_->choose_felt();
  show_felt(felt);
}

/// A state file says so, too: nothing of ParaView's own does.
void VolumeLooks::show_felt(bool felt) {
  layers_.boundaries.set_surfaces(felt);
  kept_.put(volume_look_key, felt ? felt_look : "");
}

void VolumeLooks::show_frame_values() {
  if (!readers_.source()) return;
  const int index = box_->currentIndex();
  const std::optional<std::size_t> chosen = index < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(index));
  const bool is_named = chosen && *chosen < readers_.views().looks().size();
  readers_.views().show_frame_values(*vtkSMSourceProxy::SafeDownCast(readers_.source()->getProxy()));
  const auto& looks = readers_.views().looks();
  if (looks.empty()) return;
  box_->set_looks(looks, chosen);
  if (is_named) change([&](vtkSMProxy& volume) { set_volume_look(volume, looks.at(*chosen)); });
}

void VolumeLooks::change(const std::function<void(vtkSMProxy&)>& change) {
  SCOPED_UNDO_EXCLUDE();  // follows from the scene, or from a box that says what it is
  if (!readers_.source()) return;
  for (const ClinicalView& one : readers_.views().views()) {
    if (one.kind != ViewKind::volume) continue;
    pqDataRepresentation* const shown = readers_.source()->getRepresentation(one.view);
    if (!shown) continue;
    change(*shown->getProxy());
    one.view->render();
  }
  read_opacity();
}

void VolumeLooks::read_opacity() {
  if (!readers_.source()) return;
  for (const ClinicalView& one : readers_.views().views()) {
    if (one.kind != ViewKind::volume) continue;
    if (pqDataRepresentation* const shown = readers_.source()->getRepresentation(one.view)) {
      layers_.stylus.set_opacity(opacity_of(*shown->getProxy()));
    }
  }
}

}  // namespace palpate::plugin
