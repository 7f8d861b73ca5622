#include "plugin/paraview/client/views/slice_view.h"

#include <pqRenderView.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkNew.h>
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

#include "plugin/paraview/client/views/slice_overlay.h"

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

/// Takes what it uses before ParaView's own interaction sees it, and leaves the rest (zoom, pan) alone.
class SliceView::Mouse {
 public:
  Mouse(SliceView& owner, vtkRenderWindowInteractor& interactor) : owner_(owner), interactor_(&interactor) {
    command_->SetClientData(this);
    command_->SetCallback(
        [](vtkObject*, unsigned long event, void* self, void*) { static_cast<Mouse*>(self)->handle(event); });
    constexpr float before_paraview = 10;
    for (const auto event :
         {vtkCommand::LeftButtonPressEvent, vtkCommand::LeftButtonReleaseEvent, vtkCommand::MouseMoveEvent,
          vtkCommand::MouseWheelForwardEvent, vtkCommand::MouseWheelBackwardEvent, vtkCommand::LeaveEvent,
          vtkCommand::KeyPressEvent, vtkCommand::CharEvent}) {
      observers_.push_back(interactor_->AddObserver(event, command_, before_paraview));
    }
  }
  Mouse(const Mouse&) = delete;
  Mouse& operator=(const Mouse&) = delete;
  ~Mouse() {
    for (const unsigned long observer : observers_) interactor_->RemoveObserver(observer);
  }

 private:
  void handle(unsigned long event) {
    const int* const at = interactor_->GetEventPosition();
    command_->SetAbortFlag(0);
    switch (event) {
      case vtkCommand::LeftButtonPressEvent:
        if (interactor_->GetControlKey() || interactor_->GetShiftKey()) return;
        if (pick(Pick::pressed)) {
          picking_ = true;
          break;
        }
        dragging_ = true;
        from_ = {at[0], at[1]};
        start_ = owner_.window_->window;
        break;
      case vtkCommand::LeftButtonReleaseEvent:
        if (std::exchange(picking_, false)) {
          pick(Pick::let_go);
          break;
        }
        if (!std::exchange(dragging_, false)) return;
        break;
      case vtkCommand::MouseMoveEvent:
        if (!dragging_) {
          if (picking_) pick(Pick::moved);
          owner_.pointer_ = {at[0], at[1]};
          owner_.refresh_pointer();
          if (interactor_->GetShiftKey() && !picking_ && owner_.window_->pointed_with_shift) {
            owner_.window_->pointed_with_shift(owner_.place_under(at[0], at[1]));
          }
          return;
        }
        drag_to(at[0], at[1]);
        break;
      case vtkCommand::LeaveEvent:
        owner_.pointer_.reset();
        if (owner_.overlay_->set_pointer({})) owner_.view_.render();
        return;
      case vtkCommand::KeyPressEvent:
      case vtkCommand::CharEvent: {  // which would make the view one for two eyes
        const char key = interactor_->GetKeyCode();
        if (key < '1' || key > '9' || !owner_.window_->digit_pressed) return;
        if (event == vtkCommand::KeyPressEvent) owner_.window_->digit_pressed(key - '0');
        break;
      }
      case vtkCommand::MouseWheelForwardEvent:
        owner_.leaf(1);
        break;
      case vtkCommand::MouseWheelBackwardEvent:
        owner_.leaf(-1);
        break;
      default:
        return;
    }
    command_->SetAbortFlag(1);
  }

  /// Whether places are being picked.
  bool pick(Pick what) {
    if (!owner_.window_->pick) return false;
    const int* const at = interactor_->GetEventPosition();
    const auto pick = owner_.window_->pick;  // picking may end in the call
    pick(what, owner_.place_under(at[0], at[1]));
    return true;
  }

  // To the right wider, up brighter; a drag over the view's width doubles the window or halves it.
  void drag_to(int x, int y) {
    if (!owner_.window_->gray_map) return;
    const int* const size = interactor_->GetSize();
    const double right = static_cast<double>(x - from_[0]) / std::max(size[0], 1);
    const double up = static_cast<double>(y - from_[1]) / std::max(size[1], 1);
    Window& window = owner_.window_->window;
    window.width = std::max(start_.width * std::exp2(2 * right), 1e-3);
    window.level = start_.level - up * start_.width;
    set_window(*owner_.window_->gray_map, window);
    if (owner_.window_->changed) owner_.window_->changed();
  }

  SliceView& owner_;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor_;
  vtkNew<vtkCallbackCommand> command_;
  std::vector<unsigned long> observers_;
  bool dragging_ = false, picking_ = false;
  std::array<int, 2> from_{};
  Window start_;
};

SliceView::SliceView(pqRenderView& view, vtkSMProxy& representation, const SliceSetup& setup,
                     std::shared_ptr<SharedWindow> window)
    : QObject(&view), view_(view), representation_(&representation), setup_(setup), window_(std::move(window)) {
  vtkPVRenderView& client = *client_view(view);
  overlay_ = std::make_unique<SliceOverlay>(client);
  if (client.GetInteractor()) mouse_ = std::make_unique<Mouse>(*this, *client.GetInteractor());
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
  if (pointer_) tell_of((*pointer_)[0], (*pointer_)[1]);
  if (window_->slice_shown) window_->slice_shown(*this);
  view_.render();
}

void SliceView::leaf(int steps) {
  if (window_->leafed) window_->leafed();
  // Towards head, front and left, whichever way the voxels run.
  const double up = glm::dot(setup_.sight.along, upwards(setup_.plane)) * setup_.pitch_mm;
  show_slice(setup_.slice + (up > 0 ? steps : -steps));
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
    text += QStringLiteral("   %1 %2").arg(*value, 0, 'g', 6).arg(window_->unit);
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
  overlay_->set_corner(QStringLiteral("%1  %2 / %3\nW %4  L %5")
                           .arg(name_of(setup_.plane))
                           .arg(number_of(setup_.numbers, setup_.slice, setup_.slices))
                           .arg(setup_.slices)
                           .arg(window_number(window_->window.width), window_number(window_->window.level)));
}

}  // namespace palpate::plugin
