#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QToolButton>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <string>
#include <variant>
#include <vector>

#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/tests/panel/correct_steps.h"
#include "plugin/paraview/tests/panel/mark_steps.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

// An outline is corrected with the stylus, which feels the scan's own edge.

namespace {

glm::dvec3 hand_now() {
  return panel_session().hand_mm();
}

/// The scan's edge alone is felt, strongly, and the hand presses on it.
void feel_the_edge() {
  scan_is_shown();
  correct_the_liver();
  find<QDoubleSpinBox>("palpateCorrectSnap").setValue(2.5);
  click("palpateOn0");  // the skin, which lies at the same place
  connect_stylus();
  touch_surface();
  const std::string held = panel_session().last().held;
  expect(held.find("Liver") != std::string::npos || label("palpateDepth").contains("Liver"),
         "the scan's edge at the structure holds the stylus: " + held + ", " + label("palpateDepth").toStdString());
  const glm::dvec3 begin = panel_session().last().proxy_mm;
  expect(std::abs(glm::length(begin) - ball_mm) < 0.5, "at the ball's own edge: " + std::to_string(glm::length(begin)));
}

/// How far the hand has pressed beyond what holds the stylus.
double pressed_mm() {
  const auto& now = panel_session().last();
  return glm::distance(now.probe_mm, now.proxy_mm);
}

/// To the left and up as far as that, as a hand that follows what it feels: it presses on where it feels little, and
/// gives way where it feels much.
void slide_to(double x_mm, double z_mm) {
  constexpr double near_mm = 0.6, least_mm = 0.6, most_mm = 2;
  QWidget& coronal = view("Coronal");
  for (int n = 0; n < 200; ++n) {
    const glm::dvec3 off = glm::dvec3(x_mm, 0, z_mm) - hand_now() * glm::dvec3(1, 0, 1);
    if (pressed_mm() < least_mm) {
      step_hand(coronal, "Prior");
    } else if (pressed_mm() > most_mm) {
      step_hand(coronal, "Next");
    } else if (std::abs(off.x) > near_mm) {
      step_hand(coronal, off.x > 0 ? "Right" : "Left");
    } else if (std::abs(off.z) > near_mm) {
      step_hand(coronal, off.z > 0 ? "Up" : "Down");
    } else {
      return;
    }
    handle_events(6);  // the hand goes on: it looks where it is, and does not wait
  }
  expect(false, "the hand comes to its place");
}

/// Places of the ball's own edge, evenly over the cap where its outline is off by more than half a millimeter.
std::vector<glm::dvec3> cap_that_is_off() {
  constexpr double off_mm = 0.5, every_mm = 1;
  std::vector<glm::dvec3> cap;
  for (double x = -ball_mm; x < ball_mm; x += every_mm) {
    for (double z = -ball_mm; z < ball_mm; z += every_mm) {
      const double y2 = ball_mm * ball_mm - x * x - z * z;
      if (y2 > 0 && std::sqrt(y2) > ball_mm - cut_mm + off_mm) cap.emplace_back(x, -std::sqrt(y2), z);
    }
  }
  return cap;
}

double mean_off_mm(const std::vector<glm::dvec3>& truth) {
  double sum = 0;
  for (const glm::dvec3& at : truth) sum += std::abs(felt_mm(at));
  return sum / static_cast<double>(truth.size());
}

/// With M held the stylus slides to and fro over the cap that is missing, pressed in by the hand: the outline goes
/// where the scan's edge was felt.
void an_outline_is_traced_by_touch() {
  feel_the_edge();
  constexpr double half_mm = 12, rows_mm = 3;
  slide_to(-half_mm, -half_mm);
  const std::vector<glm::dvec3> cap = cap_that_is_off();
  const double before = mean_off_mm(cap);
  expect(before > 1.5, "the cap is missing: " + std::to_string(before) + " mm in the mean");
  hold_key_in(view("Coronal"), "m", true);
  double side = 1;
  for (double z = -half_mm; z <= half_mm; z += rows_mm, side = -side) {
    const double wide = std::sqrt(std::max(12.5 * 12.5 - z * z, 16.0));
    slide_to(-side * wide, z);
    slide_to(side * wide, z);
  }
  hold_key_in(view("Coronal"), "m", false);
  wait_for("what was felt is an edit", [] { return has_edit("trace"); });
  expect(find<QTreeWidget>("palpateMarkList").topLevelItemCount() == 0, "and no mark");
  const auto trace = std::get<palpate::io::TraceEdit>(edits_in_scene().front());
  double most = 0;
  for (const palpate::io::Vec3& at : trace.points_mm) most = std::fmax(most, std::abs(glm::length(at) - ball_mm));
  constexpr double half_a_voxel_mm = 0.5;
  expect(most < half_a_voxel_mm, "its places lie at the ball's own edge: " + std::to_string(most));
  expect(trace.known_to_mm.size() == trace.points_mm.size(), "each with how well it is known");
  const auto known = std::ranges::count_if(trace.known_to_mm, [](double mm) { return mm > 0 && mm < 1; });
  expect(10 * known > 9 * static_cast<std::ptrdiff_t>(trace.points_mm.size()),
         "as the scan's edge there is: " + std::to_string(known) + " of " + std::to_string(trace.points_mm.size()));
  wait_for(
      "the outline has gone there", [&] { return mean_off_mm(cap) < 0.5 * before; }, 60);
  const double after = mean_off_mm(cap);
  expect(after <= 0.3,
         "0.3 mm from the truth in the mean: " + std::to_string(after) + ", before " + std::to_string(before));
  wait_for(
      "it is told what was changed", [] { return label("palpateCorrectChange").contains("mm at most"); }, 60);
  std::printf("an_outline_is_traced_by_touch: %.2f mm off in the mean, %.2f before, %d places\n", after, before,
              static_cast<int>(trace.points_mm.size()));
  save_screen("correct-felt");
}

/// Held in the axial slice the stylus traces along that alone, wherever the hand goes; while F is held it is free.
void a_felt_trace_stays_in_its_slice() {
  feel_the_edge();
  click(view("Axial"), QPoint(view("Axial").width() / 2, view("Axial").height() - 20));  // marks it
  click("palpateHoldInSlice");
  wait_for("it is said",
           [] { return find<QCheckBox>("palpateHoldInSlice").text() == "The stylus is held in the axial slice"; });
  const double height = height_of_slice();
  stylus_rests();
  hold_key_in(view("Sagittal"), "m", true);  // the keyboard leaves the axial view
  const double hand_height = hand_now().z;
  for (int n = 0; n < 3; ++n) {
    step("Left", 2);
    step("Up", 1);
  }
  const double up_mm = hand_now().z - hand_height;
  hold_key_in(view("Coronal"), "m", false);
  wait_for("what was felt is an edit", [] { return has_edit("trace"); });
  const auto trace = std::get<palpate::io::TraceEdit>(edits_in_scene().front());
  double most = 0;
  for (const palpate::io::Vec3& at : trace.points_mm) most = std::fmax(most, std::abs(at.z - height));
  expect(trace.points_mm.size() > 4 && most < 0.25,
         "the trace stays in the slice: " + std::to_string(trace.points_mm.size()) + " places, " +
             std::to_string(most) + " mm beside it, the hand " + std::to_string(up_mm) + " up");
  expect(up_mm > 1.5, "though the hand went up: " + std::to_string(up_mm));
  expect(height_of_slice() == height, "the view stays on the slice");
  save_screen("correct-in-slice");
  hold_key_in(view("Coronal"), "f", true);
  wait_for("F frees it", [] { return find<QCheckBox>("palpateHoldInSlice").text() == "Free while F is held"; });
  wait_for(
      "the stylus goes to the hand", [&] { return panel_session().last().proxy_mm.z > height + 1.5; }, 20);
  expect(height_of_slice() == height, "the view waits where it will be held");
  hold_key_in(view("Coronal"), "f", false);
  wait_for(
      "and is held again", [&] { return std::abs(panel_session().last().proxy_mm.z - height) < 0.25; }, 20);
  turn_wheel("Axial", 1);
  const double next = height_of_slice();
  expect(std::abs(next - height - 1) < 0.01, "the wheel shows the next slice");
  wait_for(
      "the stylus is held in that", [&] { return std::abs(panel_session().last().proxy_mm.z - next) < 0.25; }, 20);
  click("palpateHoldInSlice");
  wait_for(
      "and let go", [&] { return panel_session().last().proxy_mm.z > next + 0.5; }, 20);
}

}  // namespace

const Scenarios& felt_trace_scenarios() {
  static const Scenarios all{{"an_outline_is_traced_by_touch", an_outline_is_traced_by_touch},
                             {"a_felt_trace_stays_in_its_slice", a_felt_trace_stays_in_its_slice}};
  return all;
}
