#include "plugin/paraview/client/views/clinical_views.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqObjectBuilder.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <vtkPVRenderView.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMViewLayoutProxy.h>

#include <QCoreApplication>
#include <QWidget>

#include <algorithm>
#include <utility>

#include "plugin/paraview/client/views/clinical_views_making.h"
#include "plugin/paraview/client/views/image_lattice.h"
#include "plugin/paraview/client/views/new_views.h"
#include "plugin/paraview/client/views/patient_volume.h"
#include "plugin/paraview/client/views/slice_setup.h"

namespace palpate::plugin {

void ClinicalViews::refresh() {
  for (const auto& slice : slices_) {
    if (slice) slice->refresh_text();
  }
  for (const auto& open : views_) {
    if (open.view && open.slice) open.view->render();
  }
}

std::unique_ptr<DoubleClickEnlarges> ClinicalViews::enlarging(pqRenderView& view) {
  return std::make_unique<DoubleClickEnlarges>(view, [this](bool enlarged) {
    if (enlarged_changed_) enlarged_changed_(enlarged);
  });
}

std::vector<ClinicalView> ClinicalViews::views() const {
  std::vector<ClinicalView> open;
  for (const OpenView& one : views_) {
    if (one.view) open.push_back({one.kind, one.view, one.slice, one.kind == ViewKind::volume ? patient_ : nullptr});
  }
  return open;
}

void ClinicalViews::refresh_values() {
  for (const auto& slice : slices_) {
    if (slice) slice->refresh_pointer();
  }
}

void ClinicalViews::show_frame_values(vtkSMSourceProxy& image) {
  const Values values = lattice_of(image).values;
  if (values.speeds || windows_.empty()) return;
  const auto is_now = [this](const NamedWindow& of) {
    return of.window.level == window_->window.level && of.window.width == window_->window.width;
  };
  const auto chosen = static_cast<std::size_t>(std::ranges::find_if(windows_, is_now) - windows_.begin());
  windows_ = windows_for(values);
  if (!looks_.empty()) looks_ = volume_looks_for(values);
  if (chosen < windows_.size()) set_window(windows_[chosen].window);
}

void ClinicalViews::show_point(const glm::dvec3& place, const std::optional<glm::dvec3>& but) {
  for (const auto& slice : slices_) {
    if (slice && slice->sight().along != but) slice->show_point(place);
  }
}

void ClinicalViews::set_window(const Window& window) {
  window_->window = window;
  if (window_->gray_map) plugin::set_window(*window_->gray_map, window);
  if (window_->changed) window_->changed();
}

void ClinicalViews::set_measure(Measure measure) {
  if (std::exchange(window_->measure, measure) != measure && measure_changed_) measure_changed_(measure);
}

void ClinicalViews::set_scan_texts(const QString& identity, double thickness_mm) {
  window_->identity = identity;
  window_->thickness_mm = thickness_mm;
  refresh();
}

void ClinicalViews::set_frame_text(const QString& frame) {
  if (frame == window_->frame) return;
  window_->frame = frame;
  refresh();
}

/// As the box of windows has it.
void ClinicalViews::name_window() {
  const Window& now = window_->window;
  const auto same = std::ranges::find_if(
      windows_, [&](const NamedWindow& of) { return of.window.level == now.level && of.window.width == now.width; });
  window_->window_name = same == windows_.end()
                             ? QCoreApplication::translate("ClinicalViews", "custom")
                             : QCoreApplication::translate("palpate::plugin::ScanSection", same->name);
}

void ClinicalViews::make_room() {
  auto* const old = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  if (layout_ || !old || old->widget()->isVisible() || old->getNumberOfVisibleRepresentations() > 0) return;
  vtkSMViewLayoutProxy* const layout = layout_of(*old);
  if (!layout || layout->GetViews().size() != 1) return;
  pqApplicationCore::instance()->getObjectBuilder()->destroy(old);
  layout_ = layout;
}

ClinicalViews::ClinicalViews()
    : turns_([this](const std::string& error) {
        const Shown shown = making_ ? making_->shown : Shown();
        close();
        if (shown) shown(error);
      }) {}

ClinicalViews::~ClinicalViews() = default;

void ClinicalViews::close() {
  const QPointer<pqRenderView> half_made = making_ ? making_->view : nullptr;
  stop_making();
  slices_.clear();
  marker_.reset();
  patient_.reset();
  if (patient_changed_) patient_changed_();
  windows_.clear();
  looks_.clear();
  window_->value_at = {};
  set_measure(Measure::none);
  window_->identity.clear();
  window_->frame.clear();
  window_->thickness_mm = 0;
  auto* const builder = pqApplicationCore::instance()->getObjectBuilder();
  for (auto& open : views_) {
    open.mark.reset();
    if (open.view) builder->destroy(open.view);
  }
  if (half_made) builder->destroy(half_made);
  views_.clear();
}

void ClinicalViews::let_go() {
  stop_making();
  window_->value_at = {};  // asks the reader
}

void ClinicalViews::drop_layout() {
  vtkSMViewLayoutProxy* const layout = layout_;
  layout_ = nullptr;
  if (layout && layout->GetViews().empty()) remove_layout(*layout);
}

void ClinicalViews::stop_making() {
  turns_.clear();
  const bool was = std::exchange(making_, nullptr) != nullptr;
  if (was && making_changed_) making_changed_(false);
}

void ClinicalViews::prepare(vtkSMSourceProxy& image, const ImageLattice& lattice) {
  windows_ = windows_for(lattice.values);
  looks_ = volume_looks_for(lattice.values);
  first_look_.reset();
  window_->unit = lattice.values.hounsfield ? QStringLiteral("HU") : QString();
  window_->value_at = [probe = std::make_shared<ValueProbe>(image)](const glm::dvec3& place) {
    return probe->at(place);
  };
  window_->gray_map = gray_map(*pqActiveObjects::instance().activeServer());
  window_->pointed_with_shift = [this](const glm::dvec3& place) {
    if (window_->leafed) window_->leafed();
    show_point(place);
  };
  window_->digit_pressed = [this](int digit) {
    const auto chosen = static_cast<std::size_t>(digit - 1);
    if (chosen < windows_.size()) set_window(windows_[chosen].window);
  };
  window_->changed = [this] {
    name_window();
    refresh();
    if (window_changed_) window_changed_();
  };
  window_->measure_wanted = [this](Measure measure) { set_measure(measure); };
  window_->texts_toggled = [this] {
    window_->texts_shown = !window_->texts_shown;
    refresh();
  };
}

void ClinicalViews::add_slice(const ImageLattice& lattice, Plane plane, ViewKind kind, pqRenderView& view,
                              vtkSMProxy& shown, int slice, bool restored) {
  SliceSetup setup = setup_of(lattice, plane);
  setup.slice = slice;
  setup.keeps_camera = restored;
  slices_.emplace_back(new SliceView(view, shown, setup, window_));
  views_.push_back({kind, &view, slices_.back(), enlarging(view), std::make_unique<ViewMark>(view)});
}

void ClinicalViews::add_volume(pqRenderView& volume_view, pqPipelineSource& source) {
  const auto changed = [this] {
    if (patient_changed_) patient_changed_();
  };
  patient_ = std::make_shared<PatientVolume>(volume_view, source, window_->unit == QLatin1String("HU"), changed);
  changed();
  marker_ = std::make_unique<OrientationMarker>(
      *vtkPVRenderView::SafeDownCast(volume_view.getRenderViewProxy()->GetClientSideView()));
  // The view may also be closed by hand, and its renderer with it.
  QObject::connect(&volume_view, &QObject::destroyed, &lifetime_, [this] {
    marker_.reset();
    patient_.reset();
  });
  views_.push_back(
      {ViewKind::volume, &volume_view, nullptr, enlarging(volume_view), std::make_unique<ViewMark>(volume_view)});
  pqActiveObjects::instance().setActiveView(&volume_view);
}

void ClinicalViews::adopt(pqPipelineSource& source) {
  auto& image = *vtkSMSourceProxy::SafeDownCast(source.getProxy());
  const ImageLattice lattice = lattice_of(image);
  stop_making();
  // The views may be those of the reader before, which Undo has brought back: each has its slice still.
  for (const auto& slice : slices_) delete slice.data();
  slices_.clear();
  marker_.reset();
  patient_.reset();
  views_.clear();
  prepare(image, lattice);
  // Identified by their contents, since their names are in the language of the program that saved them.
  for (pqView* const one : source.getViews()) {
    auto* const view = qobject_cast<pqRenderView*>(one);
    pqDataRepresentation* const shown = view ? source.getRepresentation(view) : nullptr;
    if (!shown) continue;
    const std::string type = vtkSMPropertyHelper(shown->getProxy(), "Representation").GetAsString();
    if (type == "Volume" && !marker_) {
      first_look_ = look_of(*shown->getProxy(), looks_);
      add_volume(*view, source);
    }
    if (type != "Slice") continue;
    const int mode = vtkSMPropertyHelper(shown->getProxy(), "SliceMode").GetAsInt();
    const auto* const place = std::ranges::find_if(
        slice_places, [&](const auto& of) { return slice_mode(sight_of(of.plane, lattice.directions)) == mode; });
    if (place == std::end(slice_places)) continue;  // a state edited by hand
    const bool taken = std::ranges::any_of(views_, [&](const OpenView& other) { return other.kind == place->kind; });
    if (taken) continue;
    // The state's own: one of that name may be there from before.
    if (vtkSMProxy* const map = vtkSMPropertyHelper(shown->getProxy(), "LookupTable").GetAsProxy()) {
      window_->gray_map = map;
    }
    add_slice(lattice, place->plane, place->kind, *view, *shown->getProxy(),
              vtkSMPropertyHelper(shown->getProxy(), "Slice").GetAsInt(), true);
  }
  if (!views_.empty()) layout_ = layout_of(*views_.front().view);
  window_->window = window_of(*window_->gray_map);
  name_window();
  refresh();
}

}  // namespace palpate::plugin
