#include "plugin/paraview/client/views/slice_overlay.h"

#include <vtkCamera.h>
#include <vtkCommand.h>
#include <vtkPVRenderView.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkStdString.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

#include <QStringList>

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "plugin/paraview/client/views/anatomy.h"

namespace palpate::plugin {
namespace {

struct Place {
  double x, y;  // parts of the view
  int horizontal, vertical;
};
constexpr double beside_bar = 0.972, above_letter = 0.075;
constexpr std::array<Place, 8> text_places{{{beside_bar, 0.5, VTK_TEXT_RIGHT, VTK_TEXT_CENTERED},
                                            {0.015, 0.5, VTK_TEXT_LEFT, VTK_TEXT_CENTERED},
                                            {0.5, 0.985, VTK_TEXT_CENTERED, VTK_TEXT_TOP},
                                            {0.5, 0.015, VTK_TEXT_CENTERED, VTK_TEXT_BOTTOM},
                                            {0.015, 0.985, VTK_TEXT_LEFT, VTK_TEXT_TOP},
                                            {0.015, above_letter, VTK_TEXT_LEFT, VTK_TEXT_BOTTOM},
                                            {beside_bar, 0.985, VTK_TEXT_RIGHT, VTK_TEXT_TOP},
                                            {beside_bar, 0.015, VTK_TEXT_RIGHT, VTK_TEXT_BOTTOM}}};
constexpr std::size_t letters = 4, corner_text = 4, pointer = 5, identity = 6, place = 7;

/// The line, with "…" in its middle if it is wider than that many pixels: a frame's name begins and ends with what
/// tells it from the others.
QString shortened(const QString& line, int pixels, vtkTextProperty& style, int dpi) {
  const auto width_of = [&](const QString& text) {
    int box[4] = {};
    vtkTextRenderer::GetInstance()->GetBoundingBox(&style, text.toStdString(), box, dpi);
    return box[1] - box[0];
  };
  QString shown = line;
  constexpr int least = 8;
  for (int kept = static_cast<int>(line.size()) - 1; kept >= least && width_of(shown) > pixels; --kept) {
    shown = line.left(kept / 2) + QStringLiteral("…") + line.right(kept - kept / 2);
  }
  return shown;
}

}  // namespace

bool is_clear_of_texts(double x, double y) {
  constexpr double edge = 0.05, letter = 0.1, half_letter = 0.07, corner_width = 0.5, corner_height = 0.22;
  const auto inside = [](double at, double margin) { return at > margin && at < 1 - margin; };
  if (!inside(x, edge) || !inside(y, edge)) return false;
  const bool under_side_letter = !inside(x, letter) && std::abs(y - 0.5) < half_letter;
  const bool under_upper_letter = !inside(y, letter) && std::abs(x - 0.5) < half_letter;
  const bool under_corner = y > 1 - corner_height || (x > 1 - corner_width && y < corner_height);
  constexpr double pointer_width = 0.75, pointer_height = 0.15;
  const bool under_pointer = x < pointer_width && y < pointer_height;
  return !under_side_letter && !under_upper_letter && !under_corner && !under_pointer;
}

SliceOverlay::SliceOverlay(vtkPVRenderView& view, std::function<void(int)> before_drawing)
    : renderer_(view.GetNonCompositedRenderer()),
      view_(view),
      before_drawing_(std::move(before_drawing)),
      before_render_(renderer_, vtkCommand::StartEvent, [this] { update_letters(); }) {
  for (std::size_t n = 0; n < texts_.size(); ++n) {
    vtkTextActor& text = *texts_[n];
    text.GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    text.SetPosition(text_places[n].x, text_places[n].y);
    vtkTextProperty& style = *text.GetTextProperty();
    style.SetFontSize(n < letters ? 18 : 12);
    style.SetBold(n < letters);
    style.SetColor(1, 0.85, 0.35);
    // Bright bone lies under it as often as dark air.
    style.SetBackgroundColor(0, 0, 0);
    style.SetBackgroundOpacity(0.6);
    style.SetJustification(text_places[n].horizontal);
    style.SetVerticalJustification(text_places[n].vertical);
    renderer_->AddActor(texts_[n]);
  }
}

SliceOverlay::~SliceOverlay() {
  for (const auto& text : texts_) renderer_->RemoveActor(text);
}

void SliceOverlay::set_corner(const QString& text) {
  texts_[corner_text]->SetInput(text.toUtf8().constData());
}

void SliceOverlay::set_identity(const QString& text) {
  texts_[identity]->SetInput(text.toUtf8().constData());
}

void SliceOverlay::set_place(const QString& text) {
  constexpr double part = 0.9;
  const int pixels = static_cast<int>(part * renderer_->GetSize()[0]);
  if (text == place_ && pixels == place_pixels_) return;
  place_ = text;
  place_pixels_ = pixels;
  QStringList lines = text.split(QLatin1Char('\n'));
  const int dpi = view_.GetRenderWindow()->GetDPI();
  for (QString& line : lines) line = shortened(line, pixels, *texts_[place]->GetTextProperty(), dpi);
  texts_[place]->SetInput(lines.join(QLatin1Char('\n')).toUtf8().constData());
}

void SliceOverlay::set_texts_visible(bool visible) {
  for (std::size_t n = letters; n < texts_.size(); ++n) texts_[n]->SetVisibility(visible ? 1 : 0);
}

void SliceOverlay::set_identity_visible(bool visible) {
  texts_[identity]->SetVisibility(visible ? 1 : 0);
}

bool SliceOverlay::set_pointer(const QString& text) {
  if (text == pointer_) return false;
  pointer_ = text;
  texts_[pointer]->SetInput(text.toUtf8().constData());
  return true;
}

void SliceOverlay::update_letters() {
  vtkCamera& camera = *view_.GetActiveCamera();
  glm::dvec3 along, up;
  camera.GetDirectionOfProjection(&along.x);
  camera.GetViewUp(&up.x);
  const glm::dvec3 right = glm::normalize(glm::cross(along, up));
  const glm::dvec3 upright = glm::cross(right, along);  // the camera's own up need not be perpendicular
  const std::array<glm::dvec3, letters> edges{right, -right, upright, -upright};
  for (std::size_t n = 0; n < edges.size(); ++n) texts_[n]->SetInput(letters_of(edges[n]).c_str());
  if (before_drawing_) before_drawing_(renderer_->GetSize()[1]);
}

}  // namespace palpate::plugin
