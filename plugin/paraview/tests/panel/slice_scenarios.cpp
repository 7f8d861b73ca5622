// The slices: how keys and the wheel move the stylus and the slices, and how the slices follow the pointer.

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QRegularExpression>

#include <cmath>
#include <stdexcept>
#include <string>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// Ready at a place that is seen in every view, in air, without a force.
void expect_begins_in_sight() {
  click("palpateConnect");
  wait_for(
      "it is ready", [] { return label("palpateState").startsWith("Ready: no force"); }, 20);
  stylus_rests();
  views_rest();
  expect(label("palpateState").startsWith("Ready: no force") && number("palpateForce") == 0,
         "connecting turns no force on");
  expect(number("palpateTissue") < -300, "it is in air: " + label("palpateTissue").toStdString());
  for (const char* const name : {"Axial", "Sagittal", "Coronal", "Volume"}) {
    QWidget& in = view(name);
    const QPoint at = proxy_in(in);
    constexpr int edge = 10;
    expect(in.rect().adjusted(edge, edge, -edge, -edge).contains(at), std::string("it is well inside ") + name);
    const bool under_letter = std::abs(at.x() - in.width() / 2) < 12 && (at.y() < 26 || at.y() > in.height() - 26);
    const bool under_side_letter = std::abs(at.y() - in.height() / 2) < 12 && (at.x() < 26 || at.x() > in.width() - 26);
    expect(!under_letter && !under_side_letter, std::string("it is under no letter in ") + name);
  }
}

void the_hand_begins_in_sight() {
  scan_is_shown();
  expect_begins_in_sight();
  save_screen("begins-in-sight");
  turn_forces_on();
  wait_ms(1000);
  expect(number("palpateForce") == 0, "nothing is felt where it begins");
  click("palpateConnect");
  // The reach is the user's: a scene does not change it.
  click("palpateOneToOne");
  const QString reach = steady("the reach", [] { return label("palpateScale"); });
  auto& scenes = find<QComboBox>("palpateScenes");
  for (const int choice : {1, 0}) {
    scenes.setCurrentIndex(choice);
    emit scenes.activated(choice);
    wait_ms(300);
    expect(label("palpateScale") == reach, "choosing a scene leaves the reach");
  }
  expect_begins_in_sight();
  // Off a slice's plane it is said how far.
  turn_wheel("Axial", 10);
  wait_ms(800);
  save_screen("off-plane");
}

void keys_go_to_the_marked_view() {
  scan_is_shown();
  pqActiveObjects::instance().setActiveView(&render_view("Coronal"));
  connect_stylus();
  QWidget& coronal = view("Coronal");
  auto& stiffness = find<QDoubleSpinBox>("palpateStiffness");
  const double before = stiffness.value();
  move_pointer(find<QWidget>("palpateFeel"), QPoint(5, 5));  // where it was when Feel was clicked
  const QPoint at = proxy_in(coronal);
  for (int n = 0; n < 8; ++n) type_key("Up");
  wait_for(
      "the stylus goes up", [&] { return proxy_now(coronal).value_or(at).y() < at.y() - 4; }, 20);
  expect(stiffness.value() == before, "no number has changed");
  // A number that is clicked takes them, until another button is clicked.
  scroll_to(stiffness);
  click(stiffness, QPoint(20, stiffness.height() / 2));
  type_key("Up");
  wait_for(
      "the number that was clicked has changed", [&] { return stiffness.value() == before + stiffness.singleStep(); },
      20);
  click("palpateRelease");
  press_key(Qt::Key_Up);
  wait_ms(300);
  expect(stiffness.value() == before + stiffness.singleStep(), "the number stays");
  save_screen("keys-marked");
}

double part_of_place(const QString& text, const char* plus, const char* minus) {
  const auto match =
      QRegularExpression(QStringLiteral("([%1%2]) ([0-9.]+)").arg(QLatin1String(plus), QLatin1String(minus)))
          .match(text);
  if (!match.hasMatch()) throw std::runtime_error("no place is told: " + text.toStdString());
  return (match.captured(1) == QLatin1String(plus) ? 1 : -1) * match.captured(2).toDouble();
}

int slice_number(const char* in) {
  return QRegularExpression(QStringLiteral("(\\d+) / ")).match(corner_text(in)).captured(1).toInt();
}

void slices_are_scrolled() {
  scan_is_shown();
  const struct {
    const char *view, *plus, *minus;
  } ways[] = {{"Axial", "H", "F"}, {"Coronal", "A", "P"}, {"Sagittal", "L", "R"}};
  for (const auto& way : ways) {
    turn_wheel(way.view, 0);
    const double before = part_of_place(pointer_text(way.view), way.plus, way.minus);
    turn_wheel(way.view, 3);
    const double after = part_of_place(pointer_text(way.view), way.plus, way.minus);
    expect(after > before + 1.5, std::string("wheel up goes towards ") + way.plus + " in " + way.view + ": from " +
                                     std::to_string(before) + " to " + std::to_string(after));
    turn_wheel(way.view, -3);
    expect(part_of_place(pointer_text(way.view), way.plus, way.minus) == before, "and down again");
  }
  // To the image that the scanner calls number 1.
  const double first_h = qEnvironmentVariable("PALPATE_FIRST_H").toDouble();
  turn_wheel("Axial", first_h > 0 ? 200 : -200);
  expect(slice_number("Axial") == 1,
         "the scanner's first image is number 1, not " + corner_text("Axial").toStdString());
  expect(std::abs(part_of_place(pointer_text("Axial"), "H", "F") - first_h) < 0.11, "and lies where it says");

  // Following does not undo scrolling.
  connect_stylus();
  const int through = slice_number("Axial");
  turn_wheel("Axial", 6);
  const int leafed = slice_number("Axial");
  expect(std::abs(leafed - through) == 6, "the wheel leafs");
  step_hand(view("Coronal"), "Right");
  stylus_rests();
  wait_ms(1500);
  expect(slice_number("Axial") == leafed, "the slice stays, though the stylus moves");
  save_screen("leafed");
  click("palpateGoToStylus");
  wait_for(
      "Go to stylus leads back", [&] { return slice_number("Axial") == through; }, 20);
}

/// With Shift held down the pointer takes the other slices along, and the crosshair stands where they are.
void slices_follow_the_pointer() {
  scan_is_shown();
  find<QCheckBox>("palpateCrosshair").setChecked(true);
  const int axial = slice_number("Axial"), sagittal = slice_number("Sagittal"), coronal = slice_number("Coronal");
  const auto place_in = [](const char* view, const char* plus, const char* minus) {
    return part_of_place(pointer_text(view), plus, minus);
  };
  point_with_shift("Axial", 0.62, 0.4);
  const double left = place_in("Axial", "L", "R"), back = place_in("Axial", "P", "A");
  expect(std::abs(left) > 3 && std::abs(back) > 3,
         "the pointer is off the middle: " + pointer_text("Axial").toStdString());
  expect(slice_number("Axial") == axial, "the slice under the pointer stays");
  expect(slice_number("Sagittal") != sagittal && slice_number("Coronal") != coronal, "the others go");
  turn_wheel("Sagittal", 0);
  turn_wheel("Coronal", 0);
  constexpr double half_slice = 0.51, told_to = 0.1;
  expect(std::abs(place_in("Sagittal", "L", "R") - left) < half_slice + told_to,
         "the sagittal one goes through the place");
  expect(std::abs(place_in("Coronal", "P", "A") - back) < half_slice + told_to, "the coronal one, too");
  save_screen("crosshair");
}

}  // namespace

const Scenarios& slice_scenarios() {
  static const Scenarios all{
      {"the_hand_begins_in_sight", the_hand_begins_in_sight},
      {"keys_go_to_the_marked_view", keys_go_to_the_marked_view},
      {"slices_are_scrolled", slices_are_scrolled},
      {"slices_follow_the_pointer", slices_follow_the_pointer},
      {"slices_are_scrolled_upside_down", slices_are_scrolled},
  };
  return all;
}
