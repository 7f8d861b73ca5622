#include <QAction>
#include <QDoubleSpinBox>
#include <QImage>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QToolButton>
#include <QTreeWidget>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "plugin/paraview/tests/panel/drawn_lines.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

QTreeWidget& list() {
  return find<QTreeWidget>("palpateStructureList");
}

/// How many pixels of a view have nearly that color.
int pixels_of(const char* name, const QColor& color) {
  const QImage picture = view(name).grab().toImage();
  int count = 0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const QColor at = picture.pixelColor(x, y);
      const int off =
          std::abs(at.red() - color.red()) + std::abs(at.green() - color.green()) + std::abs(at.blue() - color.blue());
      if (off < 40) ++count;
    }
  }
  return count;
}

/// The widths of all lines of that color in a view, the widest first, mm.
std::vector<double> widths_drawn_in(const char* name, const QColor& color) {
  std::vector<double> widths;
  for (const DrawnLines& lines : lines_drawn_in(name, color)) widths.push_back(lines.width_mm());
  std::ranges::sort(widths, std::greater<>());
  return widths;
}

bool scene_has(const std::string& text) {
  return scene_text().find(text) != std::string::npos;
}

/// On the CT and the segmentation of its liver, in one folder; and one of another patient.
void structures_are_seen_and_felt() {
  scan_is_shown();
  click("palpateStructuresSectionFold");
  wait_for(
      "the segmentation is found with the scan", [] { return list().topLevelItemCount() == 1; }, 60);
  expect(list().topLevelItem(0)->text(0) == "Liver", "it is listed by its name");
  wait_for(
      "it is measured", [] { return !list().topLevelItem(0)->text(1).isEmpty(); }, 20);
  expect(list().topLevelItem(0)->text(1) == qEnvironmentVariable("PALPATE_LIVER"),
         "its volume is told, and not " + list().topLevelItem(0)->text(1).toStdString());
  const QColor color = list().topLevelItem(0)->icon(0).pixmap(12, 12).toImage().pixelColor(6, 6);
  wait_for(
      "its outline is on the slice", [&] { return pixels_of("Axial", color) > 200; }, 20);
  save_screen("structures");
  list().topLevelItem(0)->setCheckState(0, Qt::Unchecked);
  wait_for(
      "its outline goes with its tick", [&] { return pixels_of("Axial", color) < 20; }, 20);
  list().topLevelItem(0)->setCheckState(0, Qt::Checked);

  click("palpateStructureBoundary");
  wait_for(
      "one press makes a boundary",
      [] { return scene_has(R"("structure":"Liver")") || scene_has(R"("structure": "Liver")"); }, 20);
  click("palpateCurvesSectionFold");
  click("palpateUndo");
  wait_for(
      "which is undone", [] { return !scene_has("Liver"); }, 20);
  click("palpateRedo");
  wait_for(
      "and redone", [] { return scene_has("Liver"); }, 20);
  scroll_to(find<QWidget>("palpateStructureKeepOut"));
  click("palpateStructureKeepOut");
  wait_for(
      "one press makes a margin to keep out of", [] { return scene_has("keep_out"); }, 20);
  const std::vector<double> drawn = widths_drawn_in("Axial", color);
  expect(drawn.size() == 2 &&
             std::abs(drawn[0] - drawn[1] - 2 * find<QDoubleSpinBox>("palpateStructureMargin").value()) < 1,
         "the margin is drawn around it");
  connect_stylus();
  wait_for(
      "the distance is told",
      [] { return find<QLabel>("palpateDistance").isVisible() && label("palpateDistance").contains("Liver"); }, 20);
  save_screen("structures-felt");

  name_file("palpateAddStructures", qEnvironmentVariable("PALPATE_FOREIGN"));
  wait_for(
      "another patient's is listed, too", [] { return list().topLevelItemCount() == 2; }, 20);
  const QTreeWidgetItem& foreign = *list().topLevelItem(1);
  expect((foreign.flags() & Qt::ItemIsUserCheckable) == 0 && foreign.toolTip(0).contains("outlined on another patient"),
         "and cannot be used, which is said");
  name_file("palpateAddStructures", qEnvironmentVariable("PALPATE_OFF"));
  wait_for(
      "a label map that lies elsewhere is said to",
      [] { return list().topLevelItemCount() == 3 && list().topLevelItem(2)->text(1) == "outside the scan"; }, 20);
  expect(label("palpateStructureMessage").contains("off.mha: \"off\" lies wholly outside the scan"),
         "with its file: " + label("palpateStructureMessage").toStdString());
}

/// Two presses while the first one's structure is still being read, each with a row of its own chosen.
void a_press_is_of_what_was_chosen() {
  scan_is_shown();
  click("palpateStructuresSectionFold");
  wait_for(
      "two structures are listed", [] { return list().topLevelItemCount() == 2; }, 60);
  const auto row_of = [](const char* name) {
    const auto found = list().findItems(QLatin1String(name), Qt::MatchExactly);
    expect(found.size() == 1, std::string(name) + " is listed once");
    return found.front();
  };
  scroll_to(find<QWidget>("palpateStructureKeepOut"));
  list().setCurrentItem(row_of("Liver"));
  click("palpateStructureBoundary");
  list().setCurrentItem(row_of("Vessel"));
  click("palpateStructureKeepOut");
  list().setCurrentItem(row_of("Liver"));
  wait_for(
      "both are done", [] { return scene_has("Liver") && scene_has("Vessel"); }, 60);
  std::vector<QString> made;
  const auto scene = QJsonDocument::fromJson(QByteArray::fromStdString(steady_scene())).object();
  for (const auto& mode : scene["modes"].toArray()) {
    const QJsonObject one = mode.toObject();
    if (one.contains("structure")) made.push_back(one["type"].toString() + " of " + one["structure"].toString());
  }
  std::ranges::sort(made);
  std::string told;
  for (const QString& one : made) told += one.toStdString() + "; ";
  expect(made == std::vector<QString>{"keep_out of Vessel", "surface of Liver"},
         "a boundary of the first and a margin around the second, once each: " + told);
}

}  // namespace

const Scenarios& structure_scenarios() {
  static const Scenarios all{{"structures_are_seen_and_felt", structures_are_seen_and_felt},
                             {"a_press_is_of_what_was_chosen", a_press_is_of_what_was_chosen}};
  return all;
}
