#include "plugin/paraview/client/views/clinical_views.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqObjectBuilder.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <pqServer.h>
#include <pqServerManagerModel.h>
#include <vtkNew.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkPVDataSetAttributesInformation.h>
#include <vtkPVRenderView.h>
#include <vtkSMPVRepresentationProxy.h>
#include <vtkSMParaViewPipelineControllerWithRendering.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMTrace.h>
#include <vtkSMViewLayoutProxy.h>
#include <vtkSmartPointer.h>
#include <vtkStructuredData.h>

#include <QCoreApplication>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "plugin/paraview/client/views/image_lattice.h"
#include "plugin/paraview/client/views/patient_volume.h"
#include "plugin/paraview/client/views/scalar_coloring.h"

namespace palpate::plugin {
namespace {

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

pqRenderView* make_view(pqServer& server, ViewKind kind) {
  const bool flat = kind != ViewKind::volume;
  auto* const view = qobject_cast<pqRenderView*>(
      pqApplicationCore::instance()->getObjectBuilder()->createView(pqRenderView::renderViewType(), &server));
  vtkSMProxy& proxy = *view->getProxy();
  const auto set = [&](const char* name, int value) { vtkSMPropertyHelper(&proxy, name, true).Set(value); };
  set("UseColorPaletteForBackground", 0);
  set("OrientationAxesVisibility", 0);  // X, Y, Z
  set("CenterAxesVisibility", 0);
  if (flat) set("InteractionMode", 1);
  const double black[3] = {0, 0, 0};
  vtkSMPropertyHelper(&proxy, "Background").Set(black, 3);
  proxy.UpdateVTKObjects();
  return view;
}

vtkSMViewLayoutProxy& make_layout(pqServer& server) {
  const auto proxy = vtkSmartPointer<vtkSMProxy>::Take(server.proxyManager()->NewProxy("misc", "ViewLayout"));
  vtkNew<vtkSMParaViewPipelineController> controller;
  controller->InitializeProxy(proxy);
  server.proxyManager()->RegisterProxy("layouts", "Scan", proxy);
  return *vtkSMViewLayoutProxy::SafeDownCast(proxy);
}

vtkSMProxy& show_as(const char* representation, vtkSMSourceProxy& image, pqRenderView& view, const char* array) {
  vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
  vtkSMProxy* const shown = controller->Show(&image, 0, view.getViewProxy());
  auto* const proxy = vtkSMPVRepresentationProxy::SafeDownCast(shown);
  proxy->SetRepresentationType(representation);
  color_by_points(*proxy, array);
  hide_scalar_bar(*proxy, *view.getViewProxy());
  return *proxy;
}

constexpr int slice_mode(int index_axis) {
  return index_axis == 2 ? VTK_XY_PLANE : index_axis == 1 ? VTK_XZ_PLANE : VTK_YZ_PLANE;
}

/// Half the size of the scan as it is seen along `direction`.
double half_extent(const ImageLattice& lattice, const glm::dvec3& direction) {
  double half = 0;
  for (int axis = 0; axis < 3; ++axis) {
    half += 0.5 * (lattice.dimensions[axis] - 1) * lattice.spacing[axis] *
            std::abs(glm::dot(lattice.directions[static_cast<std::size_t>(axis)], direction));
  }
  return half;
}

/// As the scanner counts its own slices; those across them, the way the wheel goes.
SliceNumbers numbers_of(const ImageLattice& lattice, Plane plane, const Sight& sight) {
  constexpr int scanners_axis = 2;
  if (sight.index_axis == scanners_axis) return {.from_last = lattice.counted_from_last};
  return {.from_last = glm::dot(lattice.directions[static_cast<std::size_t>(sight.index_axis)], upwards(plane)) < 0};
}

constexpr struct {
  Plane plane;
  ViewKind kind;
  int cell;
} places[] = {{Plane::axial, ViewKind::axial, 3},
              {Plane::sagittal, ViewKind::sagittal, 5},
              {Plane::coronal, ViewKind::coronal, 4}};
}  // namespace

ClinicalViews::~ClinicalViews() = default;

void ClinicalViews::close() {
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
  views_.clear();
}

void ClinicalViews::refresh() {
  for (const auto& slice : slices_) {
    if (!slice) continue;
    slice->refresh_text();
  }
  for (const auto& open : views_) {
    if (open.view) open.view->render();
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

void ClinicalViews::show_point(const glm::dvec3& place) {
  for (const auto& slice : slices_) {
    if (slice) slice->show_point(place);
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

namespace {

/// A trace shows the scan in a view of ParaView's own. The clinical views are the panel's, and the panel is not there
/// when a trace is replayed.
void trace_shown(pqPipelineSource& source) {
  SM_SCOPED_TRACE(TraceText)
      .arg(("scanView = GetActiveViewOrCreate('RenderView')\n"
            "scanDisplay = Show(FindSource('" +
            source.getSMName().toStdString() +
            "'), scanView)\n"
            "scanDisplay.SetRepresentationType('Slice')\n"
            "scanView.ResetCamera()")
               .c_str())
      .arg("comment", "the scan in a view");
}

/// From the front and a little from the patient's left and above; the head up.
void look_from_the_front(const pqRenderView& view, const glm::dvec3& center) {
  const glm::dvec3 eye = center + glm::dvec3(500, -900, 300);
  const glm::dvec3 head(0, 0, 1);
  vtkSMProxy& camera = *view.getProxy();
  vtkSMPropertyHelper(&camera, "CameraPosition").Set(&eye.x, 3);
  vtkSMPropertyHelper(&camera, "CameraFocalPoint").Set(&center.x, 3);
  vtkSMPropertyHelper(&camera, "CameraViewUp").Set(&head.x, 3);
  camera.UpdateVTKObjects();
  view.getRenderViewProxy()->ResetCamera(true);
}

}  // namespace

void ClinicalViews::show(pqPipelineSource& source) {
  close();
  trace_shown(source);
  SM_SCOPED_TRACE(BlockTraceItems);
  pqServer& server = *source.getServer();
  auto& image = *vtkSMSourceProxy::SafeDownCast(source.getProxy());
  const ImageLattice lattice = lattice_of(image);

  vtkSMViewLayoutProxy* const layout = &take_layout(server);
  layout->SplitHorizontal(0, 0.5);
  layout->SplitVertical(1, 0.5);
  layout->SplitVertical(2, 0.5);

  prepare(image, lattice);
  window_->window = windows_.front().window;
  plugin::set_window(*window_->gray_map, window_->window);
  name_window();
  for (const auto& [plane, kind, cell] : places) {
    pqRenderView& view = *make_view(server, kind);
    layout->AssignView(cell, view.getViewProxy());
    vtkSMProxy& shown = show_as("Slice", image, view, lattice.array.c_str());
    const Sight sight = sight_of(plane, lattice.directions);
    vtkSMPropertyHelper(&shown, "SliceMode").Set(slice_mode(sight.index_axis));
    vtkSMPropertyHelper(&shown, "LookupTable").Set(window_->gray_map);
    vtkSMPropertyHelper(&shown, "ScalarOpacityFunction")
        .Set(vtkSMPropertyHelper(window_->gray_map, "ScalarOpacityFunction").GetAsProxy());
    shown.UpdateVTKObjects();
    add_slice(lattice, plane, kind, view, shown, lattice.dimensions[sight.index_axis] / 2, false);
  }

  pqRenderView& volume_view = *make_view(server, ViewKind::volume);
  layout->AssignView(6, volume_view.getViewProxy());
  vtkSMProxy& volume = show_as("Volume", image, volume_view, lattice.array.c_str());
  first_look_ = suited_look(lattice.values);
  set_volume_look(volume, looks_.at(*first_look_));
  look_from_the_front(volume_view, lattice.center());
  add_volume(volume_view, source);
  // Not before all are there: the next would have this one's first name again.
  for (const auto& open : views_) open.view->rename(name_of(open.kind));
  refresh();
  if (enlarged_changed_) enlarged_changed_(false);
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
  const Sight sight = sight_of(plane, lattice.directions);
  const glm::dvec3 right = glm::cross(sight.along, sight.up);
  const int slices = lattice.dimensions[sight.index_axis];
  const int right_axis = (sight.index_axis + 1) % 3, up_axis = (sight.index_axis + 2) % 3;
  constexpr int scanners_axis = 2;
  const glm::dvec3& to_next = lattice.directions[static_cast<std::size_t>(sight.index_axis)];
  slices_.emplace_back(new SliceView(view, shown,
                                     {.plane = plane,
                                      .sight = sight,
                                      .slices = slices,
                                      .slice = slice,
                                      .numbers = numbers_of(lattice, plane, sight),
                                      .as_scanned = sight.index_axis == scanners_axis,
                                      .pixel_mm = std::min(lattice.spacing[right_axis], lattice.spacing[up_axis]),
                                      .first_mm = glm::dot(lattice.origin, sight.along),
                                      .pitch_mm = lattice.spacing[sight.index_axis] * glm::dot(to_next, sight.along),
                                      .center_mm = lattice.center(),
                                      .half_height_mm = half_extent(lattice, sight.up),
                                      .half_width_mm = half_extent(lattice, right),
                                      .keeps_camera = restored},
                                     window_));
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
  slices_.clear();
  marker_.reset();
  patient_.reset();
  views_.clear();
  prepare(image, lattice);
  window_->window = window_of(*window_->gray_map);
  name_window();
  // By what they show: their names are in the language of the program that saved them.
  for (pqView* const one : source.getViews()) {
    auto* const view = qobject_cast<pqRenderView*>(one);
    pqDataRepresentation* const shown = view ? source.getRepresentation(view) : nullptr;
    if (!shown) continue;
    const std::string type = vtkSMPropertyHelper(shown->getProxy(), "Representation").GetAsString();
    if (type == "Volume" && !marker_) add_volume(*view, source);
    if (type != "Slice") continue;
    const int mode = vtkSMPropertyHelper(shown->getProxy(), "SliceMode").GetAsInt();
    const auto* const place = std::ranges::find_if(
        places, [&](const auto& of) { return slice_mode(sight_of(of.plane, lattice.directions).index_axis) == mode; });
    const bool taken = std::ranges::any_of(views_, [&](const OpenView& other) { return other.kind == place->kind; });
    if (taken) continue;
    add_slice(lattice, place->plane, place->kind, *view, *shown->getProxy(),
              vtkSMPropertyHelper(shown->getProxy(), "Slice").GetAsInt(), true);
  }
  if (!views_.empty()) layout_ = layout_of(*views_.front().view);
  refresh();
}

}  // namespace palpate::plugin
