#include "plugin/paraview/tests/panel/correct_steps.h"

#include <pqRenderView.h>
#include <vtkPVRenderView.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "modes/scene/scene_json.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/tests/panel/drawn_lines.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

QPoint pixel_of(const char* name, const glm::dvec3& place) {
  auto* const client = vtkPVRenderView::SafeDownCast(render_view(name).getRenderViewProxy()->GetClientSideView());
  vtkRenderer& renderer = *client->GetRenderer();
  renderer.SetWorldPoint(place.x, place.y, place.z, 1);
  renderer.WorldToDisplay();
  const double* const at = renderer.GetDisplayPoint();
  const QWidget& widget = view(name);
  const double ratio = widget.devicePixelRatioF();
  return {static_cast<int>(std::lround(at[0] / ratio)),
          widget.height() - 1 - static_cast<int>(std::lround(at[1] / ratio))};
}

QTreeWidget& places() {
  return find<QTreeWidget>("palpateDoubtfulPlaces");
}

QColor color_of_liver() {
  const auto rows = find<QTreeWidget>("palpateStructureList").findItems(QStringLiteral("Liver"), Qt::MatchExactly);
  expect(rows.size() == 1, "the liver is listed");
  return rows.front()->icon(0).pixmap(12, 12).toImage().pixelColor(6, 6);
}

double felt_mm(const glm::dvec3& place) {
  const auto& structures = panel_session().live().felt().structures;
  return structures.empty() ? std::nan("") : structures.front().distance->sample(place).mm;
}

double drawn_beside_felt(double pixels) {
  double most = std::nan("");
  for (const DrawnLines& lines : lines_drawn_in("Axial", color_of_liver())) {
    if (lines.pixels != pixels) continue;
    for (const glm::dvec3& at : lines.points) most = std::fmax(most, std::abs(felt_mm(at)));
  }
  return most;
}

glm::dvec3 on_the_edge(double degrees, double height_mm) {
  const double radius = std::sqrt(ball_mm * ball_mm - height_mm * height_mm);
  const double angle = degrees * std::numbers::pi / 180;
  return {radius * std::sin(angle), -radius * std::cos(angle), height_mm};
}

double height_of_slice() {
  const std::vector<DrawnLines> lines = lines_drawn_in("Axial", color_of_liver());
  expect(!lines.empty(), "the outline is drawn");
  return lines.front().points.front().z;
}

void trace_the_edge(double height_mm) {
  constexpr double from = -30, to = 30, step = 3;
  QWidget& axial = view("Axial");
  drag(axial, pixel_of("Axial", on_the_edge(from, height_mm)), pixel_of("Axial", on_the_edge(from + step, height_mm)),
       false);
  for (double at = from + 2 * step; at <= to; at += step) {
    move_pointer(axial, pixel_of("Axial", on_the_edge(at, height_mm)));
  }
  let_go();
}

bool has_edit(const char* kind) {
  const QString scene = QString::fromStdString(scene_text()).remove(' ');
  return scene.contains(QStringLiteral("\"type\":\"%1\"").arg(QString::fromLatin1(kind)));
}

std::vector<palpate::io::Edit> edits_in_scene() {
  const palpate::modes::Scene scene = palpate::modes::scene_from_json(scene_text(), "scene");
  return scene.structures.empty() ? std::vector<palpate::io::Edit>() : scene.structures.front().edits;
}

void structures_are_listed(int count) {
  click("palpateStructuresSectionFold");
  wait_for(
      "the segmentations are found and measured",
      [count] {
        const QTreeWidget& list = find<QTreeWidget>("palpateStructureList");
        int measured = 0;
        for (int n = 0; n < list.topLevelItemCount(); ++n) measured += list.topLevelItem(n)->text(1).isEmpty() ? 0 : 1;
        return measured == count;
      },
      60);
}

void correct_the_liver() {
  structures_are_listed(1);
  click("palpateCorrect");
  wait_for(
      "the cut cap is found", [] { return places().isVisible() && places().topLevelItemCount() > 0; }, 60);
}

glm::dvec3 cap_is_traced() {
  scan_is_shown();
  const int before = clicks();
  correct_the_liver();
  expect(places().topLevelItem(0)->text(1).contains("outside"),
         "the scan's edge lies outside: " + places().topLevelItem(0)->text(1).toStdString());
  scroll_to(places());
  click(*places().viewport(), places().visualItemRect(places().topLevelItem(0)).center());
  views_rest();
  save_screen("correct-place");
  const double height = height_of_slice();
  expect(std::abs(height) < 12, "the slice goes to the cap, and is at " + std::to_string(height));
  const glm::dvec3 pole = on_the_edge(0, height);
  expect(std::abs(felt_mm(pole) + ball_mm - std::hypot(cut_mm - ball_mm, height)) < 1.5,
         "the cap is missing there: " + std::to_string(felt_mm(pole)));
  trace_the_edge(height);
  wait_for("the trace is an edit", [] { return has_edit("trace"); });
  expect(clicks() - before <= 4, "it took four presses, and not " + std::to_string(clicks() - before));
  return pole;
}
