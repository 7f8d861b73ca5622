#include "plugin/paraview/client/stylus/stylus_glyphs.h"

#include <vtkActor.h>
#include <vtkBillboardTextActor3D.h>
#include <vtkConeSource.h>
#include <vtkCylinderSource.h>
#include <vtkDiskSource.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPVRenderView.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkSphereSource.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <utility>

#include "modes/tick/haptic_step.h"
#include "plugin/paraview/client/views/overlay_layer.h"
#include "plugin/paraview/client/words/mode_words.h"
#include "solver/primitive.h"

namespace palpate::plugin {
namespace {

enum Shape { ball, rod, cone, disc };

constexpr std::size_t most_primitives_shown = 6;
constexpr double stylus_pixels = 5, proxy_pixels = 6, spring_pixels = 1.2, disc_pixels = 26, rod_pixels = 60,
                 newton_pixels = 45, cone_pixels = 9, handle_pixels = 70, fin_pixels = 14;
constexpr double rim_pixels = 1.6;    // black, so that white is seen on white
constexpr double seen_faintly = 0.3;  // of something that is hidden altogether

/// Columns: any two directions across, and the direction itself second, as VTK's cylinder and cone stand.
glm::dmat3 standing_along(const glm::dvec3& direction) {
  const glm::dvec3 other = std::abs(direction.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 across = glm::normalize(glm::cross(direction, other));
  return {across, direction, glm::cross(across, direction)};
}

glm::dvec3 rgb_of(const modes::Scene& scene, std::uint32_t mode) {
  const QColor color = mode < scene.modes.size() ? color_of(scene.modes[mode]) : QColor(Qt::gray);
  return {color.redF(), color.greenF(), color.blueF()};
}

}  // namespace

/// One actor of unit size.
struct StylusGlyphs::Part {
  explicit Part(vtkAlgorithmOutput* shape) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(shape);
    actor->SetMapper(mapper);
    actor->SetUserMatrix(matrix);
    actor->PickableOff();
    actor->VisibilityOff();
    actor->GetProperty()->SetAmbient(0.4);
    actor->GetProperty()->SetDiffuse(0.6);
  }
  void place(const glm::dvec3& at, const glm::dmat3& axes, const glm::dvec3& size) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        matrix->SetElement(row, column, axes[column][row] * size[column]);
      }
      matrix->SetElement(row, 3, at[row]);
    }
    actor->VisibilityOn();
  }
  void color(const glm::dvec3& rgb, double opacity) {
    actor->GetProperty()->SetColor(rgb.x, rgb.y, rgb.z);
    actor->GetProperty()->SetOpacity(opacity);
  }
  vtkNew<vtkActor> actor;
  vtkNew<vtkMatrix4x4> matrix;
};

/// How everything is drawn now.
struct StylusGlyphs::Drawing {
  double opacity = 1;  // 0 to 1
  double mm_per_pixel = 1;
  double thick_mm() const { return 2 * spring_pixels * mm_per_pixel; }
};

std::unique_ptr<StylusGlyphs::Part> StylusGlyphs::add(int shape) {
  vtkSmartPointer<vtkPolyDataAlgorithm> source;
  switch (shape) {
    case rod: {
      vtkNew<vtkCylinderSource> made;
      made->SetRadius(1);
      made->SetResolution(12);
      source = made;
      break;
    }
    case cone: {
      vtkNew<vtkConeSource> made;
      made->SetDirection(0, 1, 0);
      made->SetRadius(0.5);
      made->SetResolution(16);
      source = made;
      break;
    }
    case disc: {
      vtkNew<vtkDiskSource> made;  // across z
      made->SetInnerRadius(0);
      made->SetOuterRadius(1);
      made->SetCircumferentialResolution(36);
      source = made;
      break;
    }
    default: {
      vtkNew<vtkSphereSource> made;
      made->SetRadius(1);
      made->SetThetaResolution(20);
      made->SetPhiResolution(14);
      source = made;
    }
  }
  auto part = std::make_unique<Part>(source->GetOutputPort());
  layer_->renderer().AddActor(part->actor);
  return part;
}

StylusGlyphs::StylusGlyphs(vtkPVRenderView& view) : layer_(std::make_unique<OverlayLayer>(view)) {
  for (std::size_t n = 0; n < most_primitives_shown; ++n) {
    planes_.push_back(add(disc));
    rods_.push_back(add(rod));
    balls_.push_back(add(ball));
  }
  for (const auto& [part, shape] : {std::pair{&dark_stylus_, ball}, {&dark_proxy_, ball}, {&dark_spring_, rod}}) {
    *part = add(shape);
    vtkProperty& rim = *(*part)->actor->GetProperty();
    rim.SetLighting(false);
    rim.FrontfaceCullingOn();  // what is seen of a shape that is a little larger is its rim
  }
  spring_ = add(rod);
  force_ = add(rod);
  tip_ = add(cone);
  stylus_ = add(ball);
  handle_ = add(rod);
  fin_ = add(rod);
  proxy_ = add(ball);
  caption_ = vtkSmartPointer<vtkBillboardTextActor3D>::New();
  caption_->SetDisplayOffset(10, 8);
  caption_->PickableOff();
  caption_->VisibilityOff();
  vtkTextProperty& style = *caption_->GetTextProperty();
  style.SetFontSize(12);
  style.SetColor(1, 1, 1);
  style.SetBackgroundColor(0, 0, 0);
  style.SetBackgroundOpacity(0.6);
  layer_->renderer().AddActor(caption_);
}

StylusGlyphs::~StylusGlyphs() = default;

void StylusGlyphs::hide() {
  caption_->VisibilityOff();
  for (const Part* part : {stylus_.get(), proxy_.get(), spring_.get(), force_.get(), tip_.get(), dark_stylus_.get(),
                           dark_proxy_.get(), dark_spring_.get(), handle_.get(), fin_.get()}) {
    part->actor->VisibilityOff();
  }
  for (const auto* parts : {&planes_, &rods_, &balls_}) {
    for (const auto& part : *parts) part->actor->VisibilityOff();
  }
}

void StylusGlyphs::show(const SessionStatus& look, const modes::Scene& scene, double faint, double mm_per_pixel,
                        const std::string& caption) {
  hide();
  if (!caption.empty()) {
    caption_->SetInput(caption.c_str());
    caption_->SetPosition(look.proxy_mm.x, look.proxy_mm.y, look.proxy_mm.z);
    caption_->VisibilityOn();
  }
  const Drawing how{1 - (1 - seen_faintly) * faint, mm_per_pixel};
  show_stylus(look, how);
  show_spring(look, how);
  show_force(look, how);
  show_shares(look, scene, how);
}

/// The stylus and the proxy, each with its rim, and the stylus' handle where its orientation is known.
void StylusGlyphs::show_stylus(const SessionStatus& look, const Drawing& how) {
  const glm::dmat3 upright(1);
  const auto sized = [&](double pixels) { return glm::dvec3(pixels * how.mm_per_pixel); };
  stylus_->place(look.probe_mm, upright, sized(stylus_pixels));
  stylus_->color({1, 1, 1}, how.opacity);
  dark_stylus_->place(look.probe_mm, upright, sized(stylus_pixels + rim_pixels));
  dark_stylus_->color(glm::dvec3(0), how.opacity);
  if (look.orientation) {
    // The handle along the stylus' own z, and at its end a fin along its y, so that rolling it shows.
    const glm::dvec3 along = *look.orientation * glm::dvec3(0, 0, 1), up = *look.orientation * glm::dvec3(0, 1, 0);
    const double length = handle_pixels * how.mm_per_pixel, thick = how.thick_mm();
    const double fin = fin_pixels * how.mm_per_pixel;
    handle_->place(look.probe_mm + along * length / 2.0, standing_along(along), {thick, length, thick});
    fin_->place(look.probe_mm + along * length + up * fin / 2.0, standing_along(up), {thick, fin, thick});
    handle_->color({1, 1, 1}, how.opacity);
    fin_->color({1, 1, 1}, how.opacity);
  }
  proxy_->place(look.proxy_mm, upright, sized(proxy_pixels));
  proxy_->color({1, 0.85, 0.2}, how.opacity);
  dark_proxy_->place(look.proxy_mm, upright, sized(proxy_pixels + rim_pixels));
  dark_proxy_->color(glm::dvec3(0), how.opacity);
}

void StylusGlyphs::show_spring(const SessionStatus& look, const Drawing& how) {
  const glm::dvec3 spring = look.proxy_mm - look.probe_mm;
  const double length = glm::length(spring);
  if (!(length > how.mm_per_pixel)) return;
  const glm::dvec3 middle = (look.proxy_mm + look.probe_mm) / 2.0;
  const glm::dmat3 axes = standing_along(glm::normalize(spring));
  const double thin = spring_pixels * how.mm_per_pixel, thicker = thin + rim_pixels * how.mm_per_pixel;
  spring_->place(middle, axes, {thin, length, thin});
  spring_->color({1, 1, 1}, how.opacity);
  dark_spring_->place(middle, axes, {thicker, length, thicker});
  dark_spring_->color(glm::dvec3(0), how.opacity);
}

/// An arrow at the proxy.
void StylusGlyphs::show_force(const SessionStatus& look, const Drawing& how) {
  const glm::dvec3 force_n = look.workspace.direction_to_patient(vector_of(look.tick.sent_n));
  const double newtons = glm::length(force_n);
  if (!(newtons > 0.02)) return;
  const glm::dvec3 along = force_n / newtons;
  const double length = newtons * newton_pixels * how.mm_per_pixel, thick = how.thick_mm();
  const glm::dmat3 axes = standing_along(along);
  force_->place(look.proxy_mm + along * length / 2.0, axes, {thick, length, thick});
  tip_->place(look.proxy_mm + along * length, axes, glm::dvec3(cone_pixels * how.mm_per_pixel));
  force_->color({0.25, 0.8, 1}, how.opacity);
  tip_->color({0.25, 0.8, 1}, how.opacity);
}

/// The primitives that act on the proxy, in the colors of their modes.
void StylusGlyphs::show_shares(const SessionStatus& look, const modes::Scene& scene, const Drawing& how) {
  const auto sized = [&](double pixels) { return glm::dvec3(pixels * how.mm_per_pixel); };
  std::size_t planes = 0, rods = 0, balls = 0;
  for (const PrimitiveRecord& share : look.shares) {
    const glm::dvec3 acts = look.workspace.direction_to_patient(vector_of(share.force_n));
    const double newtons = glm::length(acts);
    if (newtons < 0.01 || share.mode >= modes::of_scene_left) continue;
    const glm::dvec3 color = rgb_of(scene, share.mode);
    switch (static_cast<solver::PrimitiveType>(share.type)) {
      case solver::PrimitiveType::plane:
        if (planes < planes_.size()) {
          const glm::dmat3 axes = standing_along(acts / newtons);
          Part& plane = *planes_[planes++];
          plane.place(look.proxy_mm, {axes[0], axes[2], axes[1]}, sized(disc_pixels));
          plane.color(color, 0.55 * how.opacity);
        }
        break;
      case solver::PrimitiveType::point:
        if (balls < balls_.size()) {
          Part& point = *balls_[balls++];
          point.place(look.proxy_mm, glm::dmat3(1), sized(proxy_pixels * 1.6));
          point.color(color, 0.4 * how.opacity);
        }
        break;
      case solver::PrimitiveType::line:
      case solver::PrimitiveType::directed_force:
        if (rods < rods_.size()) {
          // A line pulls perpendicularly to itself, a force along itself: both are drawn by their effect on the proxy.
          const double thick = how.thick_mm();
          Part& line = *rods_[rods++];
          line.place(look.proxy_mm, standing_along(acts / newtons), {thick, rod_pixels * how.mm_per_pixel, thick});
          line.color(color, 0.8 * how.opacity);
        }
        break;
    }
  }
}

}  // namespace palpate::plugin
