// Scans in files that are not DICOM. voxel_ball.py makes them, and gives the truth.

#include <QRegularExpression>
#include <QString>
#include <QWidget>

#include <cmath>
#include <string>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

constexpr double radius_mm = 25, center_l = 12, center_p = -7, center_h = 30;

struct Told {
  double left = 0, back = 0, head = 0, value = 0;
};

double number_in(const QString& text, const char* pattern) {
  const auto match = QRegularExpression(QLatin1String(pattern)).match(text);
  expect(match.hasMatch(), "a place and a value are told: " + text.toStdString());
  return match.captured(match.lastCapturedIndex()).toDouble();
}

/// What stands under the pointer: "L 12.1 P 3.4 H 20.0  651".
Told told(const char* view) {
  const QString text = pointer_text(view);
  const auto along = [&](const char* plus, const char* minus) {
    const double size = number_in(text, (std::string("[") + plus + minus + "] ([0-9.]+)").c_str());
    return text.contains(QString::fromLatin1(plus) + QLatin1Char(' ')) ? size : -size;
  };
  return {along("L", "R"), along("P", "A"), along("H", "F"), number_in(text, "(-?[0-9.]+)$")};
}

double from_center(const Told& at) {
  return std::hypot(at.left - center_l, at.back - center_p, at.head - center_h);
}

void expect_truth(const char* view, const char* file) {
  const Told at = told(view);
  const double truth = 600 + 4 * at.left + 2 * at.back + 3 * at.head;
  constexpr double half_a_voxel = 5.5;  // of its diagonal, as the value grows along it
  expect(from_center(at) < radius_mm - 2 && std::abs(at.value - truth) < half_a_voxel,
         std::string(file) + ", " + view + ": told is \"" + pointer_text(view).toStdString() + "\", there is " +
             std::to_string(truth));
}

void expect_truth_in_all(const char* file) {
  for (const char* const view : {"Axial", "Sagittal", "Coronal"}) {
    turn_wheel(view, 0);
    expect_truth(view, file);
    turn_wheel(view, 6);
    expect_truth(view, file);
    turn_wheel(view, -6);
  }
}

/// mm from the ball's center to the slice that is shown, at right angles to it. The corner tells where the slice's
/// middle is along the patient's axis, which `cosine` turns into the lattice's.
double off_center(const char* view, const char* plus, const char* minus, double center, double cosine) {
  const QString text = place_text(view).section(QLatin1Char('\n'), 0, 0);
  const double size = number_in(text, (std::string("[") + plus + minus + "] ([0-9.]+)").c_str());
  return ((text.startsWith(QLatin1String(plus)) ? size : -size) - center) / cosine;
}

/// The slices follow the proxy: it is held at the ball's edge, and the value there is an edge's.
void expect_edge_under_stylus() {
  QWidget& coronal = view("Coronal");
  for (int presses = 0; number("palpateForce") < 0.3; ++presses) {
    expect(presses < 80, "the ball is felt");
    step_hand(coronal, "Prior");
    stylus_rests();
  }
  views_rest();
  const double degree = std::acos(-1) / 180, about_z = std::cos(20 * degree), about_x = std::cos(10 * degree);
  const double left = off_center("Sagittal", "L", "R", center_l, about_z);
  const double back = off_center("Coronal", "P", "A", center_p, about_z * about_x);
  const double head = off_center("Axial", "H", "F", center_h, about_x);
  const double held_at = std::hypot(left, back, head);
  constexpr double half_a_voxel = 1;  // of its diagonal
  expect(std::abs(held_at - radius_mm) < half_a_voxel,
         "the proxy is held at the ball's edge and not " + std::to_string(held_at) + " mm from its center");
  // Its place, by the lattice's axes (voxel_ball.py).
  const double sin_z = std::sin(20 * degree), sin_x = std::sin(10 * degree);
  const double l = center_l + about_z * left - sin_z * about_x * back + sin_z * sin_x * head;
  const double p = center_p + sin_z * left + about_z * about_x * back - about_z * sin_x * head;
  const double h = center_h + sin_x * back + about_x * head;
  const double inside = 600 + 4 * l + 2 * p + 3 * h, value = number("palpateTissue");
  expect(value > 0.2 * inside && value < 0.8 * inside,
         "the value at the proxy is an edge's: " + label("palpateTissue").toStdString() + " of " +
             std::to_string(inside) + " inside");
}

/// The slices have followed the stylus to the ball's front: wheel down leads to the back.
void scroll_to_middle() {
  for (int notches = 0; told("Coronal").back < center_p - 5; ++notches) {
    expect(notches < 60, "the wheel leads to the back: " + pointer_text("Coronal").toStdString());
    turn_wheel("Coronal", -1);
  }
}

void other_files_are_opened_and_felt() {
  name_file("palpateOpenFile", qEnvironmentVariable("PALPATE_NIFTI"));
  scan_is_shown();
  expect_truth_in_all("NIfTI");
  connect_stylus();
  expect_edge_under_stylus();
  save_screen("nifti");
  click("palpateConnect");  // no stylus any more that the slices would follow
  const unsigned nifti = reader_in_pipeline();
  drop_folder(qEnvironmentVariable("PALPATE_NRRD"));
  another_scan_is_shown(nifti);
  expect(identity_text("Axial").contains("ball.nrrd"),
         "the other file is shown: " + identity_text("Axial").toStdString());
  turn_wheel("Coronal", 0);
  scroll_to_middle();
  expect_truth_in_all("NRRD");
}

}  // namespace

const Scenarios& interchange_scenarios() {
  static const Scenarios scenarios{{"other_files_are_opened_and_felt", other_files_are_opened_and_felt}};
  return scenarios;
}
