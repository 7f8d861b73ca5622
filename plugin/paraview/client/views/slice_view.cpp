#include "plugin/paraview/client/views/slice_view.h"

#include <pqRenderView.h>
#include <vtkCamera.h>
#include <vtkPVRenderView.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMRenderViewProxy.h>

#include <QCoreApplication>
#include <QWidget>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "plugin/paraview/client/views/slice_measures.h"
#include "plugin/paraview/client/views/slice_mouse.h"
#include "plugin/paraview/client/views/slice_overlay.h"
#include "plugin/paraview/client/views/slice_scroll_bar.h"

namespace palpate::plugin {
namespace {

QString translated(const char* text) {
  return QCoreApplication::translate("SliceView", text);
}

QString name_of(Plane plane) {
  switch (plane) {
    case Plane::axial:
      return translated("Axial");
    case Plane::coronal:
      return translated("Coronal");
    case Plane::sagittal:
      break;
  }
  return translated("Sagittal");
}

/// Whole, as HU are; with digits where that would say nothing.
QString window_number(double value) {
  constexpr double small = 20;
  return std::abs(value) < small && value != std::round(value) ? QString::number(value, 'g', 3)
                                                               : QString::number(value, 'f', 0);
}

vtkPVRenderView* client_view(const pqRenderView& view) {
  return vtkPVRenderView::SafeDownCast(view.getRenderViewProxy()->GetClientSideView());
}

}  // namespace

SliceView::SliceView(pqRenderView& view, vtkSMProxy& representation, const SliceSetup& setup,
                     std::shared_ptr<SharedWindow> window)
    : QObject(&view), view_(view), representation_(&representation), setup_(setup), window_(std::move(window)) {
  vtkPVRenderView& client = *client_view(view);
  overlay_ = std::make_unique<SliceOverlay>(client, [this](int height) { tell_place(height); });
  bar_ = std::make_unique<SliceScrollBar>(client);
  if (client.GetInteractor()) {
    mouse_ = std::make_unique<SliceMouse>(*this, *client.GetInteractor());
    measures_ = std::make_unique<SliceMeasures>(*this, view_, window_);
  }
  if (!setup_.keeps_camera) place_camera();
  show_slice(setup_.slice);
}

SliceView::~SliceView() = default;

void SliceView::place_camera() {
  const glm::dvec3 eye = setup_.center_mm - 1000.0 * setup_.sight.along;  // parallel: the distance does not matter
  vtkSMProxy& view = *view_.getProxy();
  vtkSMPropertyHelper(&view, "CameraParallelProjection").Set(1);
  vtkSMPropertyHelper(&view, "CameraFocalPoint").Set(&setup_.center_mm.x, 3);
  vtkSMPropertyHelper(&view, "CameraPosition").Set(&eye.x, 3);
  vtkSMPropertyHelper(&view, "CameraViewUp").Set(&setup_.sight.up.x, 3);
  const QSize size = view_.widget()->size();
  const double aspect = size.height() > 0 ? std::max(static_cast<double>(size.width()) / size.height(), 0.1) : 1;
  constexpr double margin = 1.08;  // for the letters
  vtkSMPropertyHelper(&view, "CameraParallelScale")
      .Set(margin * std::max(setup_.half_height_mm, setup_.half_width_mm / aspect));
  view.UpdateVTKObjects();
}

void SliceView::show_slice(int slice) {
  if (!representation_) return;  // the scan was deleted; the view is still there
  setup_.slice = std::clamp(slice, 0, setup_.slices - 1);
  vtkSMPropertyHelper(representation_, "Slice").Set(setup_.slice);
  representation_->UpdateVTKObjects();
  refresh_text();
  bar_->set(runs_upwards() ? setup_.slice : setup_.slices - 1 - setup_.slice, setup_.slices);
  if (measures_) measures_->show_slice();
  if (pointer_) tell_of((*pointer_)[0], (*pointer_)[1]);
  if (window_->slice_shown) window_->slice_shown(*this);
  view_.render();
}

void SliceView::leaf(int steps) {
  if (window_->leafed) window_->leafed();
  show_slice(setup_.slice + (runs_upwards() ? steps : -steps));
}

void SliceView::scroll_to(double part) {
  const int up = static_cast<int>(std::lround(part * (setup_.slices - 1)));
  const int slice = runs_upwards() ? up : setup_.slices - 1 - up;
  if (slice == setup_.slice) return;
  if (window_->leafed) window_->leafed();
  show_slice(slice);
}

/// Towards head, front and left.
bool SliceView::runs_upwards() const {
  return glm::dot(setup_.sight.along, upwards(setup_.plane)) * setup_.pitch_mm > 0;
}

void SliceView::show_point(const glm::dvec3& place) {
  const double slice = std::round((glm::dot(place, setup_.sight.along) - setup_.first_mm) / setup_.pitch_mm);
  const int nearest = static_cast<int>(std::clamp(slice, 0.0, setup_.slices - 1.0));
  if (nearest != setup_.slice) show_slice(nearest);
}

glm::dvec3 SliceView::place_under(int x, int y) const {
  vtkRenderer& renderer = *client_view(view_)->GetRenderer();
  renderer.SetDisplayPoint(x, y, 0);
  renderer.DisplayToWorld();
  const double* const world = renderer.GetWorldPoint();
  const glm::dvec3 seen = glm::dvec3(world[0], world[1], world[2]) / world[3];
  glm::dvec3 along;
  renderer.GetActiveCamera()->GetDirectionOfProjection(&along.x);
  const double height = setup_.first_mm + setup_.slice * setup_.pitch_mm;
  return seen + along * ((height - glm::dot(seen, setup_.sight.along)) / glm::dot(along, setup_.sight.along));
}

bool SliceView::tell_of(int x, int y) {
  const glm::dvec3 place = place_under(x, y);
  QString text = QString::fromStdString(place_text(place, window_->coordinates));
  if (const auto value = window_->value_at ? window_->value_at(place) : std::nullopt) {
    const bool whole = window_->unit == QLatin1String("HU");
    text += QStringLiteral("   %1 %2")
                .arg(whole ? std::round(*value) + 0.0 : *value, 0, whole ? 'f' : 'g', whole ? 0 : 4)
                .arg(window_->unit);
  }
  return overlay_->set_pointer(text.trimmed());
}

void SliceView::refresh_pointer() {
  if (pointer_ && tell_of((*pointer_)[0], (*pointer_)[1])) view_.render();
}

double SliceView::off_plane_mm(const glm::dvec3& place) const {
  const double height = setup_.first_mm + setup_.slice * setup_.pitch_mm;
  const double along = glm::dot(place, setup_.sight.along) - height;
  return glm::dot(setup_.sight.along, upwards(setup_.plane)) > 0 ? along : -along;
}

glm::dvec3 SliceView::place_at(const glm::dvec2& off_middle_mm) const {
  const Sight& sight = setup_.sight;
  const double height = setup_.first_mm + setup_.slice * setup_.pitch_mm;
  const glm::dvec3 middle = setup_.center_mm + sight.along * (height - glm::dot(setup_.center_mm, sight.along));
  return middle + off_middle_mm.x * glm::cross(sight.along, sight.up) + off_middle_mm.y * sight.up;
}

double SliceView::half_pitch_mm() const {
  return std::abs(setup_.pitch_mm) / 2;
}

bool SliceView::shows(const glm::dvec3& place) const {
  vtkRenderer& renderer = *client_view(view_)->GetRenderer();
  double x = place.x, y = place.y, z = place.z;
  renderer.WorldToView(x, y, z);
  return is_clear_of_texts((x + 1) / 2, (y + 1) / 2);
}

void SliceView::refresh_text() {
  overlay_->set_texts_visible(window_->texts_shown);
  overlay_->set_corner(QStringLiteral("%1  %2 / %3\nW %4  L %5\n%6")
                           .arg(name_of(setup_.plane))
                           .arg(number_of(setup_.numbers, setup_.slice, setup_.slices))
                           .arg(setup_.slices)
                           .arg(window_number(window_->window.width), window_number(window_->window.level))
                           .arg(window_->window_name)
                           .trimmed());
  overlay_->set_identity(window_->identity);
}

void SliceView::set_for_picture(bool for_picture) {
  overlay_->set_identity_visible(!for_picture && window_->texts_shown);
  bar_->set_visible(!for_picture);
}

/// Where the slice lies, how thick it is, and how many pixels of the screen a pixel of it takes.
void SliceView::tell_place(int height_pixels) {
  const glm::dvec3 up = upwards(setup_.plane);
  const double at = glm::dot(place_at({0, 0}), up);
  const glm::dvec3 axis = at < 0 ? -up : up;
  QStringList lines{QStringLiteral("%1 %2 mm").arg(letters_of(axis).c_str()).arg(std::abs(at), 0, 'f', 1)};
  lines << (setup_.as_scanned && window_->thickness_mm > 0
                ? translated("%1 mm thick").arg(window_->thickness_mm, 0, 'g', 3)
                : translated("every %1 mm").arg(std::abs(setup_.pitch_mm), 0, 'g', 3));
  const double scale_mm = client_view(view_)->GetActiveCamera()->GetParallelScale();
  if (scale_mm > 0) {
    lines << translated("zoom %1 %").arg(100 * setup_.pixel_mm * height_pixels / (2 * scale_mm), 0, 'f', 0);
  }
  if (!window_->frame.isEmpty()) lines << window_->frame;
  overlay_->set_place(lines.join(QLatin1Char('\n')));
}

}  // namespace palpate::plugin
