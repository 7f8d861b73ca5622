// Corrections of structures defined by a scene, and the part of a correction that a state file keeps.

#include <pqApplicationCore.h>

#include <QComboBox>
#include <QFile>
#include <QToolButton>
#include <QTreeWidget>

#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "io/structures/structure.h"
#include "modes/scene/scene_json.h"
#include "plugin/paraview/tests/panel/correct_steps.h"
#include "plugin/paraview/tests/panel/drawn_lines.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// A cylinder of circles, which no file holds.
constexpr double drawn_mm = 12;
constexpr int drawn_planes = 11;  // 2 mm apart
QString scene_with_contours() {
  using namespace palpate;
  io::ContoursEdit contours;
  for (int plane = 0; plane < drawn_planes; ++plane) {
    auto& loop = contours.loops_mm.emplace_back();
    for (int degrees = 0; degrees < 360; degrees += 5) {
      const double angle = degrees * std::numbers::pi / 180;
      loop.emplace_back(drawn_mm * std::cos(angle), drawn_mm * std::sin(angle), 2.0 * plane - (drawn_planes - 1));
    }
  }
  modes::Scene scene;
  scene.name = "drawn";
  scene.structures.resize(1);
  scene.structures[0].name = "Liver";
  scene.structures[0].color = "#d98265";
  scene.structures[0].edits = {contours};
  modes::Mode wall;
  wall.type = "surface";
  wall.structure = "Liver";
  wall.strength_n = modes::TransferFunction(1.0);
  scene.modes = {wall};
  const QString name = qEnvironmentVariable("PALPATE_PICTURES") + QLatin1String("/drawn.json");
  QFile file(name);
  expect(file.open(QIODevice::WriteOnly), "the scene can be written");
  file.write(modes::to_json(scene).c_str());
  return name;
}

/// Contours of a scene are a structure like one of a file: listed, corrected and saved. They go with the scene.
void a_drawn_structure_is_corrected() {
  scan_is_shown();
  const QString before = find<QComboBox>("palpateScenes").currentText();
  name_file("palpateOpenScene", scene_with_contours());
  structures_are_listed(1);
  QTreeWidget& list = find<QTreeWidget>("palpateStructureList");
  expect(list.topLevelItem(0)->text(0) == "Liver", "it is listed by the scene's name");
  const double ml = list.topLevelItem(0)->text(1).split(' ').first().toDouble();
  const double expected_ml = std::numbers::pi * drawn_mm * drawn_mm * 2 * drawn_planes / 1000;
  expect(std::abs(ml - expected_ml) < 1.2, "with its volume: " + list.topLevelItem(0)->text(1).toStdString());
  wait_for("it is drawn", [] { return !lines_drawn_in("Axial", color_of_liver()).empty(); });
  click("palpateCorrect");
  wait_for(
      "it can be corrected", [] { return find<QWidget>("palpateToolAdd").isVisible() && has_edit("contours"); }, 60);
  expect(!find<QWidget>("palpateCorrectUndo").isEnabled(), "what makes it is no correction");
  click("palpateToolAdd");
  const double height = height_of_slice();
  const auto at = [height](double x) { return glm::dvec3(x, -drawn_mm, height); };
  drag(view("Axial"), pixel_of("Axial", at(-4)), pixel_of("Axial", at(4)), true);
  wait_for("a ball is added", [] { return has_edit("add"); });
  wait_for("which is felt", [&] { return std::abs(felt_mm(at(0)) - 3) < 0.7; });
  wait_for(
      "and told", [] { return label("palpateCorrectChange").contains("first drawn"); }, 60);
  views_rest();
  save_screen("correct-drawn");
  const QString file = qEnvironmentVariable("PALPATE_PICTURES") + QLatin1String("/drawn.dcm");
  QFile::remove(file);
  name_file("palpateCorrectSave", file);
  wait_for(
      "it is saved", [] { return label("palpateStructureMessage").contains("is written"); }, 60);
  const auto found = palpate::io::find_structures(std::array{std::filesystem::path(file.toStdString())});
  expect(found.structures.size() == 1 && found.structures.front().name == "Liver", "and read again, by its name");
  const auto read = palpate::io::load_distance(found.structures.front());
  expect(std::abs(read->sample(at(0)).mm - 3) < 1, "with the ball: " + std::to_string(read->sample(at(0)).mm));
  click("palpateCorrectUndo");
  wait_for("the ball is taken back", [] { return !has_edit("add") && has_edit("contours"); });
  click("palpateCorrect");
  auto& scenes = find<QComboBox>("palpateScenes");
  scenes.setCurrentIndex(scenes.findText(before));
  emit scenes.activated(scenes.currentIndex());
  wait_for("another scene has none of it", [&] { return list.topLevelItemCount() == 0; });
}

QString state_file() {
  return qEnvironmentVariable("PALPATE_PICTURES") + QLatin1String("/correct.pvsm");
}

void a_correction_is_saved() {
  cap_is_traced();
  wait_for(
      "it is told what was changed", [] { return label("palpateCorrectChange").contains("mm at most"); }, 60);
  QFile told(state_file() + ".txt");
  expect(told.open(QIODevice::WriteOnly), "what is to be restored can be written");
  told.write(label("palpateCorrectChange").toUtf8());
  expect(pqApplicationCore::instance()->saveState(state_file()), "the state is saved");
}

/// In a program of its own, started with that state: it is felt and drawn as it was, and can be taken back.
void a_correction_is_restored() {
  scan_is_shown();
  expect(edits_in_scene().size() == 1, "the scene has its edit");
  structures_are_listed(1);
  views_rest();
  const glm::dvec3 pole = on_the_edge(0, height_of_slice());
  expect(scene_text().find("Scan's edge at") == std::string::npos,
         "what held the stylus while it was corrected is not left behind");
  click("palpateCorrect");
  expect(find<QToolButton>("palpateCorrect").isChecked(), "one can go on");
  wait_for(
      "the corrected edge is felt", [&] { return std::abs(felt_mm(pole)) < 0.4; }, 60);
  wait_for(
      "and drawn", [] { return drawn_beside_felt(2) < 0.05; }, 60);
  wait_for(
      "the same is told as before",
      [] {
        QFile told(state_file() + ".txt");
        return told.open(QIODevice::ReadOnly) && QString::fromUtf8(told.readAll()) == label("palpateCorrectChange");
      },
      60);
  save_screen("correct-restored");
  click("palpateCorrectUndo");
  wait_for(
      "and takes it back", [&] { return felt_mm(pole) < -2; }, 60);
}

/// In a program that has another scan open.
void a_correction_is_loaded() {
  scan_is_shown();
  load_state(state_file());
  expect_four_views_of_one_scan();
  a_correction_is_restored();
}

}  // namespace

const Scenarios& correct_state_scenarios() {
  static const Scenarios all{{"a_drawn_structure_is_corrected", a_drawn_structure_is_corrected},
                             {"a_correction_is_saved", a_correction_is_saved},
                             {"a_correction_is_restored", a_correction_is_restored},
                             {"a_correction_is_loaded", a_correction_is_loaded}};
  return all;
}
