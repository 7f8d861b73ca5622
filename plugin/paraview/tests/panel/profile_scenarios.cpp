#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QFile>
#include <QImage>
#include <QLineEdit>
#include <QPushButton>
#include <QRegularExpression>

#include <cmath>
#include <utility>

#include "plugin/paraview/tests/panel/mark_steps.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// The largest force at the first boundary that the profile tells of, N; 0 where it tells of none.
double largest_told() {
  const auto match = QRegularExpression(QStringLiteral("up to ([0-9.]+) N")).match(label("palpateProfileReadout"));
  return match.hasMatch() ? match.captured(1).toDouble() : 0;
}

void profile_follows_an_edit() {
  scan_is_shown();
  click("palpateProfileSectionFold");
  click("palpateProfilePick");
  QWidget& sagittal = view("Sagittal");
  const QPoint middle = sagittal.rect().center();
  drag(sagittal, QPoint(sagittal.width() / 8, middle.y()), middle, true);  // the front is on the left
  wait_for(
      "a boundary is met", [] { return largest_told() > 0; }, 20);
  expect(!find<QPushButton>("palpateProfilePick").isChecked(), "picking has ended");
  scroll_to(find<QPushButton>("palpateProfilePicture"));
  steady("the profile", [] { return label("palpateProfileReadout"); });
  save_screen("profile");
  const double before = largest_told();

  auto& strength = find<QDoubleSpinBox>("palpateStrength0");
  strength.setValue(strength.value() / 2);
  wait_for(
      "the profile follows the edit", [&] { return largest_told() > 0 && largest_told() < 0.8 * before; }, 20);
  const double halved = largest_told();
  click("palpateCurvesSectionFold");
  click("palpateUndo");
  wait_for(
      "and its undoing", [&] { return largest_told() == before; }, 20);
  expect(halved < before, "less is felt of a boundary half as strong");

  QWidget& curve = find<QWidget>("palpateStrengthCurveChart");
  scroll_to(find<QWidget>("palpateStrengthCurveValue"), curve);
  const QPoint node = curve.rect().center();
  drag(curve, node, node, true);  // where there is none a click makes one
  wait_for(
      "a node is chosen", [] { return find<QDoubleSpinBox>("palpateStrengthCurveValue").isEnabled(); }, 20);
  const QString at_rest = steady("the profile", [] { return label("palpateProfileReadout"); });
  drag(curve, node, node + QPoint(0, curve.height() / 4), false);
  wait_for(
      "the profile follows a node that is being dragged", [&] { return label("palpateProfileReadout") != at_rest; },
      20);
  let_go();

  QWidget& chart = find<QWidget>("palpateProfileChart");
  scroll_to(chart, chart);
  move_pointer(chart, chart.rect().center());
  move_pointer(chart, chart.rect().center() + QPoint(3, 0));
  wait_for(
      "what is under the pointer is told",
      [] { return label("palpateProfileReadout").contains(QRegularExpression("^[0-9.]+ mm: .* N.*HU")); }, 20);

  const QString folder = qEnvironmentVariable("PALPATE_PICTURES");
  save_as("palpateProfilePicture", folder + "/profile.png");
  expect(QImage(folder + "/profile.png").width() > 500, "there is a picture of the profile");
  save_as("palpateProfileTable", folder + "/profile.csv");
  QFile table(folder + "/profile.csv");
  expect(table.open(QIODevice::ReadOnly) && table.readLine().startsWith("depth_mm,probe_x_mm") &&
             table.readAll().contains("plane"),
         "there is a table, and a plane pushes in it");

  auto& from = find<QLineEdit>("palpateProfileFrom");
  click("palpateProfilePick");
  QWidget& volume = view("Volume");
  drag(volume, volume.rect().center(), volume.rect().center(), true);
  wait_for(
      "a point is picked in the 3D view",
      [&] { return !from.text().isEmpty() && find<QLineEdit>("palpateProfileTo").text().isEmpty(); }, 20);
  const QStringList place = from.text().split(',');
  const double radius = std::hypot(place[0].toDouble(), place[1].toDouble(), place[2].toDouble());
  expect(radius > 22 && radius < 26, "it is on the ball's surface, not " + std::to_string(radius) + " mm out");
  drag(sagittal, middle, middle, true);
  wait_for(
      "and another in a slice", [] { return !find<QPushButton>("palpateProfilePick").isChecked(); }, 20);

  from.setText(QStringLiteral("0, -40 0"));
  emit from.editingFinished();
  expect(label("palpateProfileReadout").contains("not a point"), "what is no point is refused in words");
}

/// The largest forces told below the curve: now, and before the drag (0 where it is not told).
std::pair<double, double> told_below_the_curve() {
  const QStringList parts = label("palpateCurveProfileWords").split(QStringLiteral(" Before: "));
  const auto most = [](const QString& text) {
    const auto match = QRegularExpression(QStringLiteral("up to ([0-9.]+) N")).match(text);
    return match.hasMatch() ? match.captured(1).toDouble() : 0.0;
  };
  return {most(parts.front()), parts.size() > 1 ? most(parts.back()) : 0.0};
}

void a_curve_shows_its_force() {
  scan_is_shown();
  click("palpateCurvesSectionFold");
  QWidget& chart = find<QWidget>("palpateCurveProfileChart");
  scroll_to(chart, chart);
  expect(label("palpateCurveProfileWords").contains("Hold the pointer still"), "it is said how a line is chosen");

  // On the edge of the ball, as it is seen.
  QWidget& axial = view("Axial");
  const int radius = [&] {
    const QImage seen = axial.grab().toImage();
    int x = seen.width() / 2;
    const int inside = seen.pixelColor(x, seen.height() / 2).value();
    while (x > 0 && std::abs(seen.pixelColor(x, seen.height() / 2).value() - inside) < 60) --x;
    return static_cast<int>((seen.width() / 2 - x) / seen.devicePixelRatio());
  }();
  move_pointer(axial, axial.rect().center() - QPoint(radius, 0));
  wait_for(
      "the force across what is pointed at", [] { return told_below_the_curve().first > 0; }, 20);
  expect(label("palpateCurveProfileWords").startsWith("Across the place pointed at"), "it is said where");
  const double before = told_below_the_curve().first;

  QWidget& curve = find<QWidget>("palpateStrengthCurveChart");
  is_laid_out(curve);
  const QPoint node(curve.width() * 3 / 10, curve.height() / 2);  // a gradient that the ball's surface has
  drag(curve, node, node, true);                                  // where there is none a click makes one
  wait_for(
      "a node is chosen", [] { return find<QDoubleSpinBox>("palpateStrengthCurveValue").isEnabled(); }, 20);
  steady("the force across what is pointed at", [] { return label("palpateCurveProfileWords"); });
  const double at_rest = told_below_the_curve().first;
  drag(curve, node, node - QPoint(0, curve.height() / 4), false);
  wait_for(
      "while the node is dragged, both forces are told",
      [&] {
        const auto [now, was] = told_below_the_curve();
        return now > 1.1 * at_rest && std::abs(was - at_rest) < 0.011;
      },
      20);
  const auto gray = [&] {
    const QImage drawn = chart.grab().toImage();
    int count = 0;
    for (int x = drawn.width() / 4; x < drawn.width(); ++x) {
      for (int y = 4; y < drawn.height() / 2; ++y)
        count += drawn.pixelColor(x, y).saturation() < 20 && drawn.pixelColor(x, y).value() < 180;
    }
    return count;
  };
  wait_for(
      "what was felt before is drawn, too", [&] { return gray() > 10; }, 20);
  save_screen("curve-profile");
  let_go();
  expect(before > 0, "a force was told before");

  auto& strength = find<QDoubleSpinBox>("palpateStrength0");
  steady("the force once the node is let go", [] { return label("palpateCurveProfileWords"); });
  const double told = told_below_the_curve().first;
  strength.setValue(strength.value() / 2);
  wait_for(
      "a step is followed, too",
      [&] {
        const auto [now, was] = told_below_the_curve();
        return now > 0 && now < 0.7 * told && was == 0;
      },
      20);

  click("palpateProfileSectionFold");
  click("palpateProfilePick");
  QWidget& sagittal = view("Sagittal");
  const QPoint middle = sagittal.rect().center();
  drag(sagittal, QPoint(sagittal.width() / 8, middle.y()), middle, true);
  wait_for(
      "the chosen stroke is taken instead",
      [] { return label("palpateCurveProfileWords").startsWith("Along the chosen stroke"); }, 20);
}

/// The stylus goes in from the front, and the line below the curve the same way: a line across it would miss the ball.
void a_touched_boundary_shows_its_force() {
  scan_is_shown();
  click("palpateCurvesSectionFold");
  connect_stylus();
  touch_surface();
  QString past;
  wait_for(
      "a boundary is held",
      [&] {
        past = label("palpateDepth").section(" past ", 1).section(',', 0, 0);
        return !past.isEmpty();
      },
      5);
  wait_for(
      "the force across what is touched",
      [&] {
        return label("palpateCurveProfileWords").startsWith("Across the place last touched: " + past + " up to ");
      },
      10);
  save_screen("curve-touched");
}

}  // namespace

const Scenarios& profile_scenarios() {
  static const Scenarios all{{"profile_follows_an_edit", profile_follows_an_edit},
                             {"a_curve_shows_its_force", a_curve_shows_its_force},
                             {"a_touched_boundary_shows_its_force", a_touched_boundary_shows_its_force}};
  return all;
}
