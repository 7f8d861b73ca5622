#include "plugin/paraview/client/views/mark_views.h"

#include <pqRenderView.h>
#include <vtkActor.h>
#include <vtkBillboardTextActor3D.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPVRenderView.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkSmartPointer.h>
#include <vtkTextProperty.h>

#include <QString>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "plugin/paraview/client/views/overlay_layer.h"

namespace palpate::plugin {
namespace {

constexpr double near_mm = 5;             // so far off a slice a mark is still drawn on it, faintly
constexpr double rgb[3] = {1, 0.4, 0.8};  // no tissue's, and not the stylus' yellow
constexpr float ball_pixels = 10, chosen_pixels = 15, line_pixels = 2, path_pixels = 3;
constexpr double faint = 0.35;

glm::dvec3 middle_of(const glm::dvec3& a, const glm::dvec3& b) {
  return (a + b) / 2.0;
}

}  // namespace

struct MarkViews::One {
  explicit One(const ClinicalView& of)
      : slice(of.slice),
        view(of.view),
        layer(*vtkPVRenderView::SafeDownCast(of.view->getRenderViewProxy()->GetClientSideView())) {}

  void clear() {
    for (const auto& prop : props) layer.renderer().RemoveViewProp(prop);
    props.clear();
  }
  /// 1: on the slice, or no slice; 0: not to be seen.
  double opacity_at(const glm::dvec3& place) const {
    if (!slice) return 1;
    const double off_mm = std::abs(slice->off_plane_mm(place));
    if (off_mm <= std::max(slice->half_pitch_mm(), 0.5)) return 1;
    return off_mm <= near_mm ? faint : 0;
  }
  /// As well as the better seen of the two.
  double opacity_between(std::span<const glm::dvec3> places) const {
    double most = 0;
    for (const glm::dvec3& place : places) most = std::max(most, opacity_at(place));
    return most;
  }
  vtkProperty& add(std::span<const glm::dvec3> places, bool as_line, double opacity) {
    vtkNew<vtkPoints> points;
    vtkNew<vtkCellArray> cells;
    points->SetDataTypeToDouble();
    cells->InsertNextCell(static_cast<int>(places.size()));
    for (const glm::dvec3& place : places) cells->InsertCellPoint(points->InsertNextPoint(place.x, place.y, place.z));
    vtkNew<vtkPolyData> shape;
    shape->SetPoints(points);
    as_line ? shape->SetLines(cells) : shape->SetVerts(cells);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(shape);
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    actor->PickableOff();
    vtkProperty& look = *actor->GetProperty();
    look.SetLighting(false);
    look.SetColor(rgb[0], rgb[1], rgb[2]);
    look.SetOpacity(opacity);
    layer.renderer().AddActor(actor);
    props.push_back(actor);
    return look;
  }
  void write(const std::string& text, const glm::dvec3& at) {
    auto words = vtkSmartPointer<vtkBillboardTextActor3D>::New();
    words->SetInput(text.c_str());
    words->SetPosition(at.x, at.y, at.z);
    words->SetDisplayOffset(9, 6);
    words->PickableOff();
    vtkTextProperty& style = *words->GetTextProperty();
    style.SetFontSize(12);
    style.SetColor(rgb[0], rgb[1], rgb[2]);
    style.SetBackgroundColor(0, 0, 0);
    style.SetBackgroundOpacity(0.6);
    layer.renderer().AddActor(words);
    props.push_back(words);
  }
  void measure(std::span<const glm::dvec3> places, const std::string& text, const glm::dvec3& at) {
    const double opacity = opacity_between(places);
    if (opacity == 0) return;
    add(places, true, opacity).SetLineWidth(line_pixels);
    if (opacity == 1) write(text, at);
  }

  QPointer<SliceView> slice;
  QPointer<pqRenderView> view;
  OverlayLayer layer;
  std::vector<vtkSmartPointer<vtkProp>> props;
};

MarkViews::MarkViews(OpenViews& views, Ask marks)
    : marks_(std::move(marks)),
      following_(views.follow(
          Layer::marks, [this](const auto& open) { set_views(open); }, [this](SliceView& slice) { show(slice); })) {}
MarkViews::~MarkViews() = default;

void MarkViews::set_views(const std::vector<ClinicalView>& views) {
  views_.clear();
  for (const ClinicalView& view : views) draw(*views_.emplace_back(std::make_unique<One>(view)));
}

void MarkViews::set_chosen(std::vector<std::size_t> chosen) {
  if (chosen == chosen_) return;
  chosen_ = std::move(chosen);
  refresh();
}

void MarkViews::refresh() {
  for (const auto& one : views_) {
    if (!one->view) continue;
    draw(*one);
    one->view->render();
  }
}

void MarkViews::show(SliceView& slice) {
  for (const auto& one : views_) {
    if (one->slice == &slice) draw(*one);
  }
}

void MarkViews::draw(One& one) {
  one.clear();
  const Marks& marks = marks_();
  const auto place = [&](std::size_t mark) { return marks.points[mark].position_mm; };
  for (const MarkedPath& path : marks.paths) {
    const double opacity = one.opacity_between(path.points_mm);
    if (opacity == 0) continue;
    one.add(path.points_mm, true, opacity).SetLineWidth(path_pixels);
    if (opacity == 1) one.write(path.name, path.points_mm.front());
  }
  for (const MarkedDistance& of : marks.distances) {
    const glm::dvec3 ends[] = {place(of.from), place(of.to)};
    one.measure(ends, QStringLiteral("%1 mm").arg(of.mm, 0, 'f', 1).toStdString(), middle_of(ends[0], ends[1]));
  }
  for (const MarkedAngle& of : marks.angles) {
    const glm::dvec3 legs[] = {place(of.from), place(of.at), place(of.to)};
    one.measure(legs, QStringLiteral("%1\u00b0").arg(of.degrees, 0, 'f', 1).toStdString(),
                middle_of(legs[1], middle_of(legs[0], legs[2])));
  }
  std::vector<glm::dvec3> chosen;
  for (const std::size_t n : chosen_) {
    if (n < marks.points.size()) chosen.push_back(place(n));
  }
  if (const double opacity = one.opacity_between(chosen); chosen.size() > 1 && opacity > 0) {
    one.add(chosen, true, opacity).SetLineWidth(1);
  }
  for (std::size_t n = 0; n < marks.points.size(); ++n) {
    const glm::dvec3 at = place(n);
    const double opacity = one.opacity_at(at);
    if (opacity == 0) continue;
    vtkProperty& look = one.add({&at, 1}, false, opacity);
    look.SetRenderPointsAsSpheres(true);
    look.SetPointSize(std::ranges::find(chosen_, n) == chosen_.end() ? ball_pixels : chosen_pixels);
    if (opacity == 1) one.write(marks.points[n].name, at);
  }
}

}  // namespace palpate::plugin
