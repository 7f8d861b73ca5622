#include "plugin/paraview/client/views/boundary_contours.h"

#include <pqRenderView.h>
#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPVRenderView.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>
#include <utility>

#include "modes/scene/scene_json.h"
#include "plugin/paraview/client/jobs/job.h"
#include "plugin/paraview/client/views/felt_contours.h"
#include "plugin/paraview/client/views/felt_surfaces.h"
#include "plugin/paraview/client/views/overlay_layer.h"
#include "plugin/paraview/client/words/mode_words.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {
namespace {

constexpr double most_points = 600;  // across a slice
constexpr std::size_t most_kept = 6;

SlicePoints points_of(const SliceView& slice, const io::Volume& volume) {
  const glm::dvec2 half = slice.half_size_mm();
  const io::Geometry& geometry = volume.geometry;
  const double voxel = std::min({geometry.spacing_i, geometry.spacing_j, geometry.slice_spacing()});
  const double step = std::max(voxel, 2 * std::max(half.x, half.y) / most_points);
  SlicePoints points;
  points.corner = slice.place_at(-half);
  points.right = slice.place_at({step - half.x, -half.y}) - points.corner;
  points.up = slice.place_at({-half.x, step - half.y}) - points.corner;
  points.columns = 1 + static_cast<int>(2 * half.x / step);
  points.rows = 1 + static_cast<int>(2 * half.y / step);
  return points;
}

}  // namespace

struct BoundaryContours::Felt {
  std::string key;  ///< of the scene
  std::shared_ptr<const io::Volume> volume;
  modes::Scene scene;
  std::shared_ptr<const modes::Plan> plan;
  std::shared_ptr<const io::FieldSource> source;
};

struct BoundaryContours::One {
  struct Drawn {
    std::shared_ptr<const Felt> felt;
    std::vector<FeltContour> contours;
    int slice = -1;  ///< that they lie on
  };

  explicit One(const ClinicalView& of)
      : slice(of.slice),
        view(of.view),
        layer(*vtkPVRenderView::SafeDownCast(of.view->getRenderViewProxy()->GetClientSideView())) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(lines);
    mapper->SetScalarModeToUseCellData();
    actor->SetMapper(mapper);
    actor->PickableOff();
    actor->GetProperty()->SetLighting(false);
    actor->GetProperty()->SetLineWidth(2);
    layer.renderer().AddActor(actor);
  }

  void draw(const Drawn& drawn);
  void keep(const std::shared_ptr<const Drawn>& drawn) {
    kept.push_front(drawn);
    if (kept.size() > most_kept) kept.pop_back();
    draw(*drawn);
  }
  /// The lines of a scene on the slice that is shown; null if they are not kept.
  std::shared_ptr<const Drawn> kept_of(const Felt& felt) const {
    const auto is_it = [&](const auto& drawn) {
      return drawn->felt && drawn->slice == slice->slice() && drawn->felt->volume == felt.volume &&
             drawn->felt->key == felt.key;
    };
    const auto found = std::ranges::find_if(kept, is_it);
    return found == kept.end() ? nullptr : *found;
  }
  /// Lines of another slice, or of another scan, are not to be seen over this one while its own are computed.
  void hide_others(const std::shared_ptr<const io::Volume>& volume) {
    if (drawn_slice != slice->slice() || drawn_volume.lock() != volume) actor->VisibilityOff();
  }

  QPointer<SliceView> slice;
  QPointer<pqRenderView> view;
  OverlayLayer layer;
  vtkNew<vtkPolyData> lines;
  vtkNew<vtkActor> actor;
  int drawn_slice = -1;
  std::weak_ptr<const io::Volume> drawn_volume;
  std::deque<std::shared_ptr<const Drawn>> kept;
  Job job{Job::Newer::follows};  // last: it ends before what it draws
};

void BoundaryContours::One::draw(const Drawn& drawn) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("PalpateBoundary");
  colors->SetNumberOfComponents(3);
  for (const FeltContour& contour : drawn.contours) {
    const QColor color = color_of(drawn.felt->scene.modes[contour.mode]);
    for (const auto& piece : contour.pieces) {
      const vtkIdType ends[] = {points->InsertNextPoint(&piece[0].x), points->InsertNextPoint(&piece[1].x)};
      cells->InsertNextCell(2, ends);
      colors->InsertNextTuple3(color.red(), color.green(), color.blue());
    }
  }
  lines->Initialize();
  lines->SetPoints(points);
  lines->SetLines(cells);
  lines->GetCellData()->SetScalars(colors);
  drawn_slice = drawn.slice;
  drawn_volume.reset();
  if (drawn.felt) drawn_volume = drawn.felt->volume;
  actor->SetVisibility(slice && drawn_slice == slice->slice() ? 1 : 0);
  if (view) view->render();
}

BoundaryContours::BoundaryContours(OpenViews& views)
    : surfaces_(std::make_unique<FeltSurfaces>()),
      following_(views.follow(
          Layer::outlines, [this](const auto& open) { set_views(open); }, [this](SliceView& slice) { show(slice); })) {}
BoundaryContours::~BoundaryContours() = default;

void BoundaryContours::set_views(const std::vector<ClinicalView>& views) {
  surfaces_->set_views(views);
  views_.clear();
  for (const ClinicalView& view : views) {
    if (view.slice) views_.push_back(std::make_unique<One>(view));
  }
}

void BoundaryContours::set_felt(const std::shared_ptr<const io::Volume>& volume, const modes::Scene& scene,
                                const std::shared_ptr<const modes::Plan>& plan, Pace pace) {
  auto felt = std::make_shared<Felt>();
  felt->key = modes::to_json(scene);
  felt->volume = volume;
  felt->scene = scene;
  felt->plan = plan;
  if (volume && plan) {
    const bool same_source = felt_ && felt_->source && felt_->volume == volume && felt_->plan->fields == plan->fields &&
                             felt_->scene.gradient_scale_mm == scene.gradient_scale_mm &&
                             felt_->scene.sampling == scene.sampling;
    io::FieldOptions options = modes::field_options(scene.sampling);
    options.brick_bytes = 0;  // lines lie anywhere: what is kept for the stylus stays about it
    options.background = false;
    felt->source =
        same_source ? felt_->source
                    : std::make_shared<const io::VolumeFields>(
                          volume, scan_fields(*plan) | io::FieldSet::value,
                          scene.gradient_scale_mm.value_or(io::default_gradient_scale_mm(volume->geometry)), options);
  }
  felt_ = std::move(felt);
  surfaces_->set_felt(volume, scene, plan, felt_->source);
  for (const auto& one : views_) {
    if (pace == Pace::stepped) one->job.cancel();
    if (!volume) one->kept.clear();
    draw(*one);
  }
}

void BoundaryContours::set_visible(bool visible) {
  visible_ = visible;
  for (const auto& one : views_) draw(*one);
}

void BoundaryContours::set_surfaces(bool visible) {
  surfaces_->set_visible(visible);
}

std::optional<io::Sample> BoundaryContours::sample(const glm::dvec3& place) const {
  if (!felt_ || !felt_->source) return std::nullopt;
  const io::Sample found =
      felt_->source->sample(place, felt_->source->available() & (io::FieldSet::value | io::FieldSet::gradient));
  return found.inside ? std::optional(found) : std::nullopt;
}

void BoundaryContours::show(SliceView& slice) {
  for (const auto& one : views_) {
    if (one->slice == &slice) draw(*one);
  }
}

void BoundaryContours::draw(One& one) {
  if (!one.slice || !one.view) return;
  if (!visible_ || !felt_ || !felt_->source) {
    one.job.cancel();
    one.draw({});
    return;
  }
  if (const auto kept = one.kept_of(*felt_)) {
    one.job.cancel();
    return one.draw(*kept);
  }
  one.hide_others(felt_->volume);
  one.job.ask(
      [felt = felt_, points = points_of(*one.slice, *felt_->volume),
       slice = one.slice->slice()](const Job::Control& control) -> One::Drawn {
        return {felt, felt_contours(felt->scene, *felt->plan, *felt->source, points, control.keep_going), slice};
      },
      [&one](const std::shared_ptr<const One::Drawn>& drawn, const QString&) {
        if (drawn) one.keep(drawn);
      });
}

}  // namespace palpate::plugin
