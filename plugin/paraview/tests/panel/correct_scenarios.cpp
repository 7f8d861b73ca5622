#include <pqCoreUtilities.h>
#include <pqRenderView.h>
#include <vtkPVRenderView.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>

#include <QDialog>
#include <QDoubleSpinBox>
#include <QFile>
#include <QGuiApplication>
#include <QLabel>
#include <QPixmap>
#include <QScreen>
#include <QToolButton>
#include <QTreeWidget>

#include <array>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "io/structures/structure.h"
#include "modes/scene/scene_json.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/tests/panel/drawn_lines.h"
#include "plugin/paraview/tests/panel/mark_steps.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

constexpr double ball_mm = 25, cut_mm = 4;  // of the phantom, and how deep its outline's cap is cut off

/// The pixel of a view at which a place of the patient is seen.
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
  const QTreeWidgetItem& row = *find<QTreeWidget>("palpateStructureList").topLevelItem(0);
  return row.icon(0).pixmap(12, 12).toImage().pixelColor(6, 6);
}

/// The outline's distance at a place as the session has it; NaN where none is felt.
double felt_mm(const glm::dvec3& place) {
  const auto& structures = panel_session().live().felt().structures;
  return structures.empty() ? std::nan("") : structures.front().distance->sample(place).mm;
}

/// The farthest that a line of that width lies from where the felt distance is zero, mm; NaN where there is no line.
double drawn_beside_felt(double pixels) {
  double most = std::nan("");
  for (const DrawnLines& lines : lines_drawn_in("Axial", color_of_liver())) {
    if (lines.pixels != pixels) continue;
    for (const glm::dvec3& at : lines.points) most = std::fmax(most, std::abs(felt_mm(at)));
  }
  return most;
}

/// The ball's edge in front, on the slice that is shown.
glm::dvec3 on_the_edge(double degrees, double height_mm) {
  const double radius = std::sqrt(ball_mm * ball_mm - height_mm * height_mm);
  const double angle = degrees * std::numbers::pi / 180;
  return {radius * std::sin(angle), -radius * std::cos(angle), height_mm};
}

/// Where the axial slice lies.
double height_of_slice() {
  const std::vector<DrawnLines> lines = lines_drawn_in("Axial", color_of_liver());
  expect(!lines.empty(), "the outline is drawn");
  return lines.front().points.front().z;
}

/// The pointer along the ball's edge over the cut cap, with the button held.
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

/// What is on the screen there, where guide_pictures.py asks for it.
void save_for_guide(const char* name, QWidget& shown) {
  const QString folder = qEnvironmentVariable("PALPATE_GUIDE");
  if (folder.isEmpty()) return;
  scroll_to(shown);
  wait_ms(1000);
  const QRect at(shown.mapToGlobal(QPoint(0, 0)), shown.size());
  const QPixmap picture = QGuiApplication::primaryScreen()->grabWindow(0, at.x(), at.y(), at.width(), at.height());
  expect(picture.save(folder + QLatin1Char('/') + QLatin1String(name) + ".png"), "a picture for the guide is written");
}

/// The structures' section is unfolded, and *Correct* is pressed for the only one.
void correct_the_liver() {
  click("palpateStructuresSectionFold");
  wait_for(
      "the segmentation is found and measured",
      [] {
        const QTreeWidget& list = find<QTreeWidget>("palpateStructureList");
        return list.topLevelItemCount() == 1 && !list.topLevelItem(0)->text(1).isEmpty();
      },
      60);
  click("palpateCorrect");
  wait_for(
      "the cut cap is found", [] { return places().isVisible() && places().topLevelItemCount() > 0; }, 60);
}

/// From an opened study with a segmentation whose cap was cut off to the first corrected edge: the middle of the trace.
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

/// Opened, mended, undone, saved, read again.
void an_outline_is_corrected() {
  const glm::dvec3 pole = cap_is_traced();
  const auto is_felt = [&] { return std::abs(felt_mm(pole)) < 0.4; };
  wait_for("the corrected edge is felt where it was drawn: " + std::to_string(felt_mm(pole)), is_felt, 20);
  wait_for(
      "it is told what was changed", [] { return label("palpateCorrectChange").contains("mm at most"); }, 60);
  views_rest();
  expect(drawn_beside_felt(2) < 0.05, "what is drawn is what is felt: " + std::to_string(drawn_beside_felt(2)));
  expect(drawn_beside_felt(1) > 2, "the outline of the file is drawn beside it");
  save_screen("correct-traced");
  save_for_guide("correct", *pqCoreUtilities::mainWidget());
  save_for_guide("correct-tools", find<QWidget>("palpateCorrectBox"));
  hold_key_in(view("Axial"), "b", true);
  const bool shown = comes_true([] { return drawn_beside_felt(2) > 2 && std::isnan(drawn_beside_felt(1)); });
  expect(shown, "a key shows the file's outline: " + std::to_string(drawn_beside_felt(2)) + ", " +
                    std::to_string(drawn_beside_felt(1)) + ", " + label("palpateStructureMessage").toStdString() +
                    (has_edit("trace") ? "" : ", without an edit"));
  hold_key_in(view("Axial"), "b", false);
  wait_for(
      "and lets it go", [] { return drawn_beside_felt(2) < 0.05; }, 20);

  const double mended = felt_mm(pole);
  click("palpateCorrectUndo");
  wait_for(
      "one press undoes it", [] { return !has_edit("trace"); }, 20);
  wait_for(
      "what is felt is the file's outline", [&] { return felt_mm(pole) < -2; }, 20);
  click("palpateCorrectRedo");
  wait_for(
      "and redoes it, to the bit", [&] { return felt_mm(pole) == mended; }, 20);
  connect_stylus();
  wait_for(
      "the distance of the corrected outline is told",
      [] { return find<QLabel>("palpateDistance").isVisible() && label("palpateDistance").contains("Liver"); }, 20);

  const QString file = qEnvironmentVariable("PALPATE_CORRECTED");
  QFile::remove(file);
  name_file("palpateCorrectSave", file);
  wait_for(
      "it is saved", [] { return label("palpateStructureMessage").contains("is written"); }, 60);
  const auto found = palpate::io::find_structures(std::array{std::filesystem::path(file.toStdString())});
  expect(found.structures.size() == 1 && found.structures.front().name == "Liver", "it is read again, by its name");
  const auto read = palpate::io::load_distance(found.structures.front());
  expect(std::abs(read->sample(pole).mm) < 1, "with the traced edge: " + std::to_string(read->sample(pole).mm));
  const double saved_ml = palpate::io::measure(found.structures.front()).volume_mm3 / 1000;
  expect(
      std::abs(saved_ml - number("palpateCorrectChange")) < 0.3,
      "as large as it was told: " + std::to_string(saved_ml) + " ml, " + label("palpateCorrectChange").toStdString());
  views_rest();
  save_screen("correct-saved");
}

/// To the archive that the scan is in; archive_test.py looks what has come there.
void an_outline_is_sent() {
  cap_is_traced();
  wait_for(
      "it is told what was changed", [] { return label("palpateCorrectChange").contains("mm at most"); }, 60);
  in_dialog("palpateCorrectSend", [](QDialog& dialog) {
    expect(label("palpateSendPatient") == "Muster, Erika  ·  P1",
           "for whom: " + label("palpateSendPatient").toStdString());
    const QString what = label("palpateSendWhat");
    expect(what.startsWith("A segmentation (SEG) of Liver.") && what.contains("mm at most"),
           "what, and what has changed: " + what.toStdString());
    save_screen("correct-send");
    dialog.reject();
  });
  wait_ms(300);
  expect(label("palpateStructureMessage").isEmpty() && !find<QWidget>("palpateOutlineOut").isVisible(),
         "what is only looked at is not sent");
  in_dialog("palpateCorrectSend", [](QDialog&) { click("palpateSendOk"); });
  wait_for("it is sent", [] { return label("palpateStructureMessage") == "Sent to clinic: the corrected outline."; });
}

/// With M held the stylus slides on the scan's edge, pressed in by the hand: the outline goes where it was felt.
void an_outline_is_traced_by_touch() {
  scan_is_shown();
  correct_the_liver();
  expect(find<QToolButton>("palpateCorrect").isChecked(), "it is being corrected");
  find<QDoubleSpinBox>("palpateCorrectSnap").setValue(2.5);
  click("palpateOn0");  // the skin, which lies at the same place
  connect_stylus();
  touch_surface();
  const std::string held = panel_session().last().held;
  expect(held.find("Liver") != std::string::npos || label("palpateDepth").contains("Liver"),
         "the scan's edge at the structure holds the stylus: " + held + ", " + label("palpateDepth").toStdString());
  const glm::dvec3 begin = panel_session().last().proxy_mm;
  expect(std::abs(glm::length(begin) - ball_mm) < 0.5, "at the ball's own edge: " + std::to_string(glm::length(begin)));
  hold_key_in(view("Coronal"), "m", true);
  step("Left", 6);  // towards the middle, where the ball is thicker
  hold_key_in(view("Coronal"), "m", false);
  wait_for("what was felt is an edit", [] { return has_edit("trace"); });
  expect(find<QTreeWidget>("palpateMarkList").topLevelItemCount() == 0, "and no mark");
  const palpate::modes::Scene scene = palpate::modes::scene_from_json(scene_text(), "scene");
  const auto& trace = std::get<palpate::io::TraceEdit>(scene.structures.at(0).edits.at(0));
  expect(trace.points_mm.size() > 3, "of several places");
  double most = 0;
  for (const palpate::io::Vec3& at : trace.points_mm) most = std::fmax(most, std::abs(glm::length(at) - ball_mm));
  std::string all;
  for (const palpate::io::Vec3& at : trace.points_mm) all += " " + std::to_string(glm::length(at) - ball_mm);
  expect(most < 0.5, "they lie at the ball's own edge:" + all);
  wait_for("the outline has gone there", [&] {
    double beside = 0;
    for (const palpate::io::Vec3& at : trace.points_mm) beside = std::fmax(beside, std::abs(felt_mm(at)));
    return beside < 0.5;
  });
  views_rest();
  save_screen("correct-felt");
}

/// A ball is added to the outline: it is seen before where it is and how large.
void a_ball_is_added() {
  scan_is_shown();
  correct_the_liver();
  click("palpateToolAdd");
  const glm::dvec3 pole = on_the_edge(0, height_of_slice());
  const QColor brush(255, 240, 77);
  move_pointer(view("Axial"), pixel_of("Axial", pole));
  wait_for(
      "the ball is seen under the pointer, of 3 mm",
      [&] {
        const auto circles = lines_drawn_in("Axial", brush);
        return circles.size() == 1 && std::abs(circles.front().width_mm() - 6) < 0.1;
      },
      20);
  save_screen("correct-brush");
  drag(view("Axial"), pixel_of("Axial", pole), pixel_of("Axial", on_the_edge(15, pole.z)), true);
  wait_for("what it passed over is added", [] { return has_edit("add"); });
  wait_for("and felt", [&] { return std::abs(felt_mm(pole) - 3) < 0.7; });
  wait_for(
      "it is told how much", [] { return number("palpateCorrectChange") > 60; }, 60);
  click("palpateToolRemove");
  drag(view("Axial"), pixel_of("Axial", pole), pixel_of("Axial", on_the_edge(15, pole.z)), true);
  wait_for("and taken away again", [] { return has_edit("remove"); });
  wait_for("which is felt", [&] { return felt_mm(pole) < -2; });
}

}  // namespace

const Scenarios& correct_scenarios() {
  static const Scenarios all{{"an_outline_is_corrected", an_outline_is_corrected},
                             {"an_outline_is_traced_by_touch", an_outline_is_traced_by_touch},
                             {"a_ball_is_added", a_ball_is_added},
                             {"an_outline_is_sent", an_outline_is_sent}};
  return all;
}
