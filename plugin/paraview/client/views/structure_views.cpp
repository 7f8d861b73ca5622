#include "plugin/paraview/client/views/structure_views.h"

#include <pqRenderView.h>
#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPVRenderView.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "plugin/paraview/client/views/overlay_layer.h"
#include "plugin/paraview/common/structure_shapes.h"

namespace palpate::plugin {
namespace {

/// The part of a slice in which a structure and its margins can be; of zero size if there is none.
Sheet sheet_of(const SliceView& slice, const DrawnStructure& structure, double margin_mm) {
  const glm::dvec3 middle = slice.place_at({0, 0});
  const glm::dvec3 right = glm::normalize(slice.place_at({1, 0}) - middle);
  const glm::dvec3 up = glm::normalize(slice.place_at({0, 1}) - middle);
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 at((corner & 1) != 0 ? structure.high_mm.x : structure.low_mm.x,
                        (corner & 2) != 0 ? structure.high_mm.y : structure.low_mm.y,
                        (corner & 4) != 0 ? structure.high_mm.z : structure.low_mm.z);
    const glm::dvec3 off(glm::dot(at - middle, right), glm::dot(at - middle, up),
                         glm::dot(at - middle, slice.sight().along));
    low = glm::min(low, off);
    high = glm::max(high, off);
  }
  low -= margin_mm;
  high += margin_mm;
  if (low.z > 0 || high.z < 0) return {};
  return {.corner = middle + low.x * right + low.y * up,
          .right = right,
          .up = up,
          .size_mm = {high.x - low.x, high.y - low.y}};
}

}  // namespace

struct StructureViews::One {
  explicit One(const ClinicalView& of)
      : slice(of.slice),
        view(of.view),
        layer(*vtkPVRenderView::SafeDownCast(of.view->getRenderViewProxy()->GetClientSideView())) {}

  void clear() {
    for (const auto& actor : actors) layer.renderer().RemoveActor(actor);
    actors.clear();
  }
  vtkActor& add(vtkPolyData* shape, const QColor& color) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(shape);
    mapper->ScalarVisibilityOff();
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    actor->PickableOff();
    actor->GetProperty()->SetColor(color.redF(), color.greenF(), color.blueF());
    layer.renderer().AddActor(actor);
    actors.push_back(actor);
    return *actor;
  }

  /// Where the distance is `at_mm`, on the slice that is shown.
  void outline(const DrawnStructure& structure, const io::DistanceField& distance, double at_mm, bool wide) {
    constexpr float line_pixels = 2, thin_pixels = 1;
    constexpr double thin_opacity = 0.7;
    const Sheet sheet = sheet_of(*slice, structure, std::max(-at_mm, 0.0));
    if (sheet.size_mm.x <= 0 || sheet.size_mm.y <= 0) return;
    vtkProperty& look = *add(outline_of(distance, sheet, at_mm), structure.color).GetProperty();
    look.SetLighting(false);
    look.SetLineWidth(wide ? line_pixels : thin_pixels);
    look.SetOpacity(wide ? 1 : thin_opacity);
  }

  QPointer<SliceView> slice;
  QPointer<pqRenderView> view;
  OverlayLayer layer;
  std::vector<vtkSmartPointer<vtkActor>> actors;
};

StructureViews::StructureViews(OpenViews& views)
    : following_(views.follow(
          Layer::outlines, [this](const auto& open) { set_views(open); }, [this](SliceView& slice) { show(slice); })) {}
StructureViews::~StructureViews() = default;

void StructureViews::set_views(const std::vector<ClinicalView>& views) {
  views_.clear();
  structures_.clear();
  for (const ClinicalView& view : views) views_.push_back(std::make_unique<One>(view));
}

void StructureViews::set_structures(std::vector<DrawnStructure> structures, double opacity) {
  // Every edit of the scene comes here, and a picture of the volume may take seconds.
  if (structures == structures_ && opacity == opacity_) return;
  structures_ = std::move(structures);
  opacity_ = opacity;
  for (const auto& one : views_) {
    if (!one->view) continue;
    if (one->slice) {
      show(*one->slice);
    } else {
      one->clear();
      for (const DrawnStructure& structure : structures_) {
        if (!structure.surface || opacity_ <= 0) continue;
        one->add(structure.surface, structure.color).GetProperty()->SetOpacity(opacity_);
      }
    }
    one->view->render();
  }
}

void StructureViews::show(SliceView& slice) {
  for (const auto& one : views_) {
    if (one->slice != &slice) continue;
    one->clear();
    for (const DrawnStructure& structure : structures_) {
      one->outline(structure, *structure.distance, 0, true);
      if (structure.before) one->outline(structure, *structure.before, 0, false);
      for (const double at_mm : structure.margins_mm) one->outline(structure, *structure.distance, at_mm, false);
    }
  }
}

}  // namespace palpate::plugin
