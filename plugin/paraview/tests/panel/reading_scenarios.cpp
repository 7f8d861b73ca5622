// What a radiologist reads and does in a slice: corner texts, the scroll bar, lengths and angles.

#include <QCheckBox>
#include <QComboBox>
#include <QFile>
#include <QImage>
#include <QPoint>
#include <QString>
#include <QStringList>
#include <QToolButton>
#include <QWidget>

#include <algorithm>
#include <cmath>
#include <string>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

constexpr double ball_mm = 50, pixel_mm = 0.8;  // of the phantom

/// mm, of the scanner's image with that number, from 1.
double height_of_image(int number) {
  const QStringList heights = qEnvironmentVariable("PALPATE_HEIGHTS").split(' ');
  expect(number >= 1 && number <= heights.size(), "there is an image " + std::to_string(number));
  return heights[number - 1].toDouble();
}

int image_shown() {
  return corner_text("Axial").section("Axial", 1).section('/', 0, 0).trimmed().toInt();
}

/// "H 12.0 mm" or "F 12.0 mm", towards the head.
double height_told() {
  const QStringList words = place_text("Axial").section('\n', 0, 0).split(' ');
  expect(words.size() == 3 && (words[0] == "H" || words[0] == "F"),
         "a height is told: " + place_text("Axial").toStdString());
  return (words[0] == "H" ? 1 : -1) * words[1].toDouble();
}

void expect_height(const char* when) {
  const double truth = height_of_image(image_shown());
  expect(std::abs(height_told() - truth) < 0.06, std::string(when) + " the height is the file's " +
                                                     std::to_string(truth) + ", not " +
                                                     place_text("Axial").toStdString());
}

/// Pixels from the middle of the ball to where it ends in a picture, to that side.
int edge(const QImage& picture, const QPoint& middle, int step) {
  const int bright = picture.pixelColor(middle).value();
  QPoint at = middle;
  while (picture.rect().contains(at) && picture.pixelColor(at).value() > bright / 2) at.rx() += step;
  return at.x();
}

/// Of the yellow of the texts, in the upper right corner.
int yellow_in_corner(const QImage& picture) {
  int yellow = 0;
  for (int y = 0; y < picture.height() / 6; ++y) {
    for (int x = picture.width() * 2 / 3; x < picture.width(); ++x) {
      const QColor color = picture.pixelColor(x, y);
      yellow += color.red() > 150 && color.blue() < 0.6 * color.red() ? 1 : 0;
    }
  }
  return yellow;
}

void expect_texts() {
  const QString identity = identity_text("Sagittal");
  for (const char* const part : {"DOE, JANE ANN", "ID 4711", "7: Neck thin", "2019-03-12"}) {
    expect(identity.contains(part), std::string("the corner tells ") + part + ": " + identity.toStdString());
  }
  expect(place_text("Axial").contains("1 mm thick"), "the scanner's slices are as thick as it says");
  expect(place_text("Coronal").contains("every 0.8 mm"), "those across them are as far apart as its pixels");
}

/// The ball is measured from one edge to the other, as it is seen.
void measure_the_ball(QWidget& axial) {
  const QImage picture = axial.grab().toImage();
  const QPoint middle = picture.rect().center();
  const int left = edge(picture, middle, -1), right = edge(picture, middle, 1);
  const double zoom = 100 * (right - left) / ball_mm * pixel_mm;
  const QString told = place_text("Axial").section("zoom ", 1).section(' ', 0, 0);
  expect(std::abs(told.toDouble() - zoom) < 0.03 * zoom,
         "the ball is seen as large as the zoom says: " + std::to_string(zoom) + " %, " + told.toStdString());
  const QString window = corner_text("Axial");
  press_key_in(axial, "l");
  wait_for(
      "the toolbar knows", [] { return find<QToolButton>("palpateRulerButton").isChecked(); }, 20);
  drag(axial, {left, middle.y()}, {right, middle.y()}, true);
  wait_for(
      "a length is told", [] { return measured_in("Axial").size() == 1; }, 20);
  const double length = measured_in("Axial").first().section(' ', 0, 0).toDouble();
  expect(std::abs(length - ball_mm) < 0.025 * ball_mm,
         "the ball is 50 mm wide: " + measured_in("Axial").first().toStdString());
  expect(!find<QToolButton>("palpateRulerButton").isChecked(), "one length at a time");
  expect(corner_text("Axial") == window, "the window was left alone");
}

void measure_an_angle(QWidget& axial) {
  const QPoint corner = axial.rect().center() + QPoint(-20, 40);
  click("palpateAngleButton");
  drag(axial, corner + QPoint(90, 0), corner, true);
  drag(axial, corner + QPoint(60, -60), corner + QPoint(60, -60), true);
  wait_for(
      "an angle is told", [] { return measured_in("Axial").size() == 2; }, 20);
  const QString angle = measured_in("Axial").last();
  expect(angle.endsWith("°") && std::abs(angle.section(QChar(0xb0), 0, 0).toDouble() - 45) < 1.5,
         "it is 45 degrees: " + angle.toStdString());
}

/// A ball of 50 mm that somebody has had scanned.
void slices_are_read_and_measured() {
  scan_is_shown();
  find<QCheckBox>("palpateContours").setChecked(false);
  views_rest();
  QWidget& axial = view("Axial");
  expect_texts();
  expect_height("at first");
  turn_wheel("Axial", 3);
  expect_height("after the wheel");
  turn_wheel("Axial", -3);

  measure_the_ball(axial);
  measure_an_angle(axial);
  save_screen("measured");
  turn_wheel("Axial", 1);
  expect(measured_in("Axial").isEmpty(), "what was measured on a slice is not on the next");
  turn_wheel("Axial", -1);
  expect(measured_in("Axial").size() == 2, "but on its own");
  press_key_in(axial, "Delete");
  wait_for(
      "the key takes the last away", [] { return measured_in("Axial").size() == 1; }, 20);
  press_key_in(axial, "Delete");
  wait_for(
      "and the one before it", [] { return measured_in("Axial").isEmpty(); }, 20);

  const int at_bar = axial.width() - 4;
  drag(axial, {at_bar, axial.height() / 2}, {at_bar, 1}, true);
  const QStringList heights = qEnvironmentVariable("PALPATE_HEIGHTS").split(' ');
  const double highest = std::max(heights.first().toDouble(), heights.last().toDouble());
  wait_for(
      "the bar leads to the head's end", [&] { return std::abs(height_told() - highest) < 0.06; }, 20);
  expect_height("after the bar");

  const QPoint low(axial.width() / 4, axial.height() * 3 / 4);
  drag(axial, low, low + QPoint(40, 10), true);
  wait_for(
      "the window is nobody's", [] { return corner_text("Coronal").endsWith("custom"); }, 20);
  press_key_in(axial, "1");
  wait_for(
      "and has its name again", [] { return corner_text("Coronal").endsWith("Soft tissue"); }, 20);

  const int written = yellow_in_corner(axial.grab().toImage());
  expect(written > 60, "the patient is told in the picture on the screen: " + std::to_string(written));
  const QString file = qEnvironmentVariable("PALPATE_PICTURES") + QStringLiteral("/read.png");
  click("palpateOneUpButton");
  is_laid_out(axial);
  views_rest();
  save_as("palpatePictureButton", file);
  const int saved = yellow_in_corner(QImage(file));
  expect(saved == 0, "but in no picture that is saved: " + std::to_string(saved));
  click("palpateFourUpButton");
  is_laid_out(axial);
  press_key_in(axial, "i");
  wait_for(
      "the key takes the texts away", [] { return identity_text("Axial").isEmpty() && corner_text("Axial").isEmpty(); },
      20);
  press_key_in(axial, "i");
  wait_for(
      "and brings them back", [] { return identity_text("Axial").contains("DOE"); }, 20);
}

}  // namespace

const Scenarios& reading_scenarios() {
  static const Scenarios scenarios{{"slices_are_read_and_measured", slices_are_read_and_measured}};
  return scenarios;
}
