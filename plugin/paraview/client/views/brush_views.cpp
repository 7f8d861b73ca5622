#include "plugin/paraview/client/views/brush_views.h"

#include <pqRenderView.h>
#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPVRenderView.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRegularPolygonSource.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSphereSource.h>

#include <QPointer>

#include <cmath>
#include <glm/geometric.hpp>

#include "plugin/paraview/client/views/overlay_layer.h"

namespace palpate::plugin {
namespace {

constexpr double brush_rgb[3] = {1, 0.94, 0.3};
constexpr int corners = 64;

}  // namespace

struct BrushViews::One {
  explicit One(const ClinicalView& of)
      : slice(of.slice),
        view(of.view),
        layer(*vtkPVRenderView::SafeDownCast(of.view->getRenderViewProxy()->GetClientSideView())) {
    circle->SetNumberOfSides(corners);
    circle->GeneratePolygonOff();
    ball->SetThetaResolution(corners / 2);
    ball->SetPhiResolution(corners / 2);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(slice ? circle->GetOutputPort() : ball->GetOutputPort());
    actor->SetMapper(mapper);
    actor->PickableOff();
    actor->VisibilityOff();
    vtkProperty& look = *actor->GetProperty();
    look.SetColor(brush_rgb[0], brush_rgb[1], brush_rgb[2]);
    if (slice) look.SetLighting(false);
    if (!slice) look.SetOpacity(0.5);
    layer.renderer().AddActor(actor);
  }
  ~One() { layer.renderer().RemoveActor(actor); }
  One(const One&) = delete;
  One& operator=(const One&) = delete;

  /// Whether it is seen here.
  bool place(const Brush& brush) {
    glm::dvec3 center = brush.center_mm;
    if (!slice) {
      ball->SetCenter(&center.x);
      ball->SetRadius(brush.radius_mm);
      return true;
    }
    const glm::dvec3 along = slice->sight().along;
    const double off = glm::dot(center - slice->place_at({0, 0}), along);
    if (std::abs(off) >= brush.radius_mm) return false;
    center -= off * along;
    circle->SetCenter(&center.x);
    circle->SetNormal(along.x, along.y, along.z);
    circle->SetRadius(std::sqrt(brush.radius_mm * brush.radius_mm - off * off));
    return true;
  }

  QPointer<SliceView> slice;
  QPointer<pqRenderView> view;
  OverlayLayer layer;
  vtkNew<vtkRegularPolygonSource> circle;
  vtkNew<vtkSphereSource> ball;
  vtkNew<vtkActor> actor;
};

BrushViews::BrushViews(OpenViews& views)
    : following_(views.follow(Layer::paths, [this](const auto& open) { set_views(open); })) {}
BrushViews::~BrushViews() = default;

void BrushViews::set_views(const std::vector<ClinicalView>& views) {
  views_.clear();
  brush_.reset();
  for (const ClinicalView& view : views) views_.push_back(std::make_unique<One>(view));
}

void BrushViews::show(const std::optional<Brush>& brush) {
  if (brush == brush_) return;
  brush_ = brush;
  for (const auto& one : views_) {
    if (!one->view) continue;
    const bool was = one->actor->GetVisibility() != 0;
    const bool is = brush && one->place(*brush);
    one->actor->SetVisibility(is ? 1 : 0);
    if (one->slice && (was || is)) one->view->render();
  }
}

}  // namespace palpate::plugin
