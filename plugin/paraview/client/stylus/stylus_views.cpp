#include "plugin/paraview/client/stylus/stylus_views.h"

#include <pqRenderView.h>
#include <vtkCamera.h>
#include <vtkMath.h>
#include <vtkPVRenderView.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>

#include <QCoreApplication>
#include <QWidget>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "io/fields/volume_fields.h"
#include "plugin/paraview/client/stylus/mapping.h"
#include "plugin/paraview/client/views/caster.h"
#include "plugin/paraview/client/views/slice_overlay.h"
#include "plugin/paraview/client/views/volume_pick.h"

namespace palpate::plugin {
namespace {

constexpr qint64 shortest_ms = 30;
constexpr qint64 rest_of = 2;       // times as long as a view took to draw it is left alone
constexpr qint64 settled_ms = 200;  // after that long at rest the volume is drawn in full
constexpr double moved_pixels = 0.5;
constexpr double turned_part = 1e-4;  // 1 - cos of half the angle: 1.6 degrees

vtkPVRenderView* client_view(pqRenderView& view) {
  return vtkPVRenderView::SafeDownCast(view.getRenderViewProxy()->GetClientSideView());
}

double visible_height_mm(vtkCamera& camera) {
  return camera.GetParallelProjection() != 0
             ? 2 * camera.GetParallelScale()
             : 2 * camera.GetDistance() * std::tan(vtkMath::RadiansFromDegrees(camera.GetViewAngle()) / 2);
}

/// "12 mm in front": of the slice.
QString distance_in_words(Plane plane, double off_mm) {
  const auto translated = [](const char* text) { return QCoreApplication::translate("StylusViews", text); };
  const bool up = off_mm > 0;
  const QString way = plane == Plane::axial ? (up ? translated("%1 mm above") : translated("%1 mm below"))
                      : plane == Plane::coronal
                          ? (up ? translated("%1 mm in front") : translated("%1 mm behind"))
                          : (up ? translated("%1 mm to the left") : translated("%1 mm to the right"));
  return way.arg(std::abs(off_mm), 0, 'f', 0);
}

}  // namespace

struct StylusViews::OneView {
  OneView(SessionController& session, const ClinicalView& of)
      : kind(of.kind),
        view(of.view),
        slice(of.slice),
        client(client_view(*of.view)),
        glyphs(*client),
        hand(session, *client) {}

  bool has_moved(const SessionStatus& look, double mm_per_pixel) const {
    const auto moved = [&](const glm::dvec3& a, const glm::dvec3& b) {
      return glm::length(a - b) > moved_pixels * mm_per_pixel;
    };
    return look.is_seen() != drawn.is_seen() || look.clutched != drawn.clutched ||
           moved(look.probe_mm, drawn.probe_mm) || moved(look.proxy_mm, drawn.proxy_mm) ||
           std::lround(off_plane_mm(look)) != drawn_off_mm || std::abs(look.force_n - drawn.force_n) > 0.02 ||
           look.shares.size() != drawn.shares.size() || has_turned(look);
  }

  bool has_turned(const SessionStatus& look) const {
    if (look.orientation.has_value() != drawn.orientation.has_value()) return true;
    return look.orientation && 1 - std::abs(glm::dot(*look.orientation, *drawn.orientation)) > turned_part;
  }

  /// Of the slice that is shown: how far the stylus is off it. 0: on it, or no slice.
  double off_plane_mm(const SessionStatus& look) const {
    if (!slice || !look.is_seen()) return 0;
    const double off_mm = slice->off_plane_mm(look.proxy_mm);
    return std::abs(off_mm) > std::max(slice->half_pitch_mm(), 0.5) ? off_mm : 0;
  }

  ViewKind kind;
  QPointer<pqRenderView> view;
  QPointer<SliceView> slice;
  vtkSmartPointer<vtkPVRenderView> client;
  StylusGlyphs glyphs;
  StylusHand hand;
  std::unique_ptr<VolumePick> pick;
  SessionStatus drawn;
  long drawn_off_mm = 0;
  qint64 next_ms = 0;
  qint64 moved_ms = 0;
  bool coarse = false;  ///< drawn last with less detail than it can have
};

StylusViews::StylusViews(OpenViews& views, SessionController& session, const SceneModel& model)
    : session_(session),
      model_(model),
      following_(views.follow(Layer::stylus, [this](const auto& open) { set_views(open); })) {}

StylusViews::~StylusViews() = default;

void StylusViews::set_views(const std::vector<ClinicalView>& views) {
  views_.clear();
  values_of_.reset();  // a scan that is closed is not held
  values_.reset();
  for (const ClinicalView& view : views) {
    OneView& one = *views_.emplace_back(std::make_unique<OneView>(session_, view));
    if (one.kind != ViewKind::volume) continue;
    one.pick = std::make_unique<VolumePick>(
        *one.client, [this](Pick what, const auto& near, const auto& far) { return pick(what, near, far); });
  }
  clock_.start();
}

Eye StylusViews::eye() const {
  for (const auto& one : views_) {
    if (one->kind != ViewKind::volume || !one->view) continue;
    vtkCamera& camera = *one->client->GetActiveCamera();
    Eye eye;
    camera.GetPosition(&eye.position.x);
    camera.GetFocalPoint(&eye.focus.x);
    camera.GetViewUp(&eye.up.x);
    eye.height_mm = visible_height_mm(camera);
    return eye;
  }
  return {};
}

bool StylusViews::shows(const glm::dvec3& place) {
  follow_scan();
  constexpr double half = 0.5;
  for (const auto& one : views_) {
    if (!one->view) continue;
    if (one->slice) {
      if (!one->slice->shows(place)) return false;
      continue;
    }
    double x = place.x, y = place.y, z = place.z;
    one->client->GetRenderer()->WorldToView(x, y, z);
    if (!is_clear_of_texts((x + 1) / 2, (y + 1) / 2)) return false;
    glm::dvec3 eye;
    one->client->GetActiveCamera()->GetPosition(&eye.x);
    if (values_ && hidden_part(*values_, opacity_, eye, place) > half) return false;
  }
  return true;
}

void StylusViews::follow_scan() {
  if (session_.live().felt_scan() == values_of_) return;
  values_of_ = session_.live().felt_scan();
  values_ = values_of_
                ? std::make_shared<const io::VolumeFields>(values_of_, io::FieldSet::value, 1,
                                                           io::FieldOptions{.brick_bytes = 0, .background = false})
                : nullptr;
}

bool StylusViews::pick(Pick what, const glm::dvec3& near, const glm::dvec3& far) {
  if (const auto rays = rays_) return rays(what, near, far);  // a copy, as below
  if (!pick_) return false;
  follow_scan();
  if (!values_) return false;
  const auto seen = first_seen(*values_, opacity_, near, far);
  if (!seen && what == Pick::pressed) return false;
  if (seen) picked_mm_ = *seen;
  // Where nothing is visible a drag keeps its last place. A copy is called, because the call may end the picking.
  const auto pick = pick_;
  pick(what, picked_mm_);
  return true;
}

bool StylusViews::show(const SessionStatus& look) {
  // ParaView handles events while it closes a view, whose widget has gone by then.
  std::erase_if(views_, [](const auto& one) { return !one->view || !one->view->widget(); });
  if (views_.empty()) return false;
  follow_scan();
  const qint64 now_ms = clock_.elapsed();
  // One view a look: the panel and the mouse have their turn between.
  for (std::size_t turn = 0; turn < views_.size(); ++turn) {
    OneView& one = *views_[(next_ + turn) % views_.size()];
    if (now_ms < one.next_ms || !one.view->widget()->isVisible()) continue;
    vtkCamera& camera = *one.client->GetActiveCamera();
    const double mm_per_pixel = visible_height_mm(camera) / std::max(one.view->widget()->height(), 1);
    const bool moved = one.has_moved(look, mm_per_pixel);
    const bool settled = one.coarse && now_ms - one.moved_ms > settled_ms;
    if (!moved && !settled) continue;
    if (moved) {
      one.drawn = look;
      one.moved_ms = now_ms;
      if (look.is_seen()) {
        glm::dvec3 eye;
        camera.GetPosition(&eye.x);
        const bool volume = one.kind == ViewKind::volume;
        const double off_mm = one.off_plane_mm(look);
        one.drawn_off_mm = std::lround(off_mm);
        constexpr double faint_off_plane = 0.85;
        const double faint = off_mm != 0         ? faint_off_plane
                             : volume && values_ ? hidden_part(*values_, opacity_, eye, look.proxy_mm)
                                                 : 0;
        one.glyphs.show(look, look.scene ? *look.scene : model_.scene(), faint, mm_per_pixel,
                        off_mm != 0 ? distance_in_words(one.slice->plane(), off_mm).toStdString() : std::string());
      } else {
        one.glyphs.hide();
      }
    }
    const bool fast = moved && one.kind == ViewKind::volume;
    if (fast) {
      one.view->getRenderViewProxy()->InteractiveRender();
      one.coarse = true;
    } else {
      one.coarse = !draw_in_turns(*one.client->GetRenderer(), [&] { one.view->forceRender(); });
    }
    const bool has_turns = !fast && one.coarse;
    one.next_ms = clock_.elapsed() + (has_turns ? 0 : std::max(shortest_ms, rest_of * (clock_.elapsed() - now_ms)));
    next_ = (next_ + turn + 1) % views_.size();
    return has_turns;
  }
  return false;
}

}  // namespace palpate::plugin
