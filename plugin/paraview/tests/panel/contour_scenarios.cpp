// The lines of the boundaries on the slices: their place, their colors, and their behavior while a node is dragged.

#include <pqApplicationCore.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>
#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkSMRenderViewProxy.h>

#include <QCheckBox>
#include <QColor>
#include <QFile>
#include <QImage>
#include <QLineEdit>
#include <QRegularExpression>
#include <QRegularExpressionMatch>
#include <QStringList>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "plugin/paraview/client/views/event_watch.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

struct Piece {
  std::array<double, 3> middle{};
  std::array<int, 3> color{};
};

/// As they stand in the view's own pictures.
std::vector<Piece> drawn_in(const char* name) {
  std::vector<Piece> pieces;
  for (pqRenderView* const view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>()) {
    if (view->getSMName() != QLatin1String(name)) continue;
    vtkRendererCollection& layers = *view->getRenderViewProxy()->GetRenderWindow()->GetRenderers();
    for (int layer = 0; layer < layers.GetNumberOfItems(); ++layer) {
      vtkActorCollection& actors = *vtkRenderer::SafeDownCast(layers.GetItemAsObject(layer))->GetActors();
      for (int n = 0; n < actors.GetNumberOfItems(); ++n) {
        auto* const actor = vtkActor::SafeDownCast(actors.GetItemAsObject(n));
        auto* const mapper = vtkPolyDataMapper::SafeDownCast(actor->GetMapper());
        vtkPolyData* const lines = mapper ? mapper->GetInput() : nullptr;
        vtkDataArray* const colors = lines ? lines->GetCellData()->GetArray("PalpateBoundary") : nullptr;
        if (!colors || actor->GetVisibility() == 0) continue;
        for (vtkIdType cell = 0; cell < lines->GetNumberOfCells(); ++cell) {
          Piece piece;
          const double* const bounds = lines->GetCell(cell)->GetBounds();
          for (int axis = 0; axis < 3; ++axis) {
            piece.middle[static_cast<std::size_t>(axis)] = 0.5 * (bounds[2 * axis] + bounds[2 * axis + 1]);
            piece.color[static_cast<std::size_t>(axis)] = static_cast<int>(colors->GetComponent(cell, axis));
          }
          pieces.push_back(piece);
        }
      }
    }
  }
  return pieces;
}

double radius_of(const Piece& piece) {
  return std::hypot(piece.middle[0], piece.middle[1], piece.middle[2]);
}

double mean_radius(const std::vector<Piece>& pieces) {
  double sum = 0;
  for (const Piece& piece : pieces) sum += radius_of(piece);
  return sum / static_cast<double>(pieces.size());
}

/// Where the proxy is first held along a stroke, mm: read from the profile's table.
std::array<double, 3> first_held(const QString& file) {
  QFile table(file);
  expect(table.open(QIODevice::ReadOnly), "there is a table of the profile");
  const QStringList names = QString::fromUtf8(table.readLine()).trimmed().split(',');
  const auto column = [&](const char* name) { return names.indexOf(QLatin1String(name)); };
  while (!table.atEnd()) {
    const QStringList row = QString::fromUtf8(table.readLine()).split(',');
    const double force = std::hypot(row[column("force_x_n")].toDouble(), row[column("force_y_n")].toDouble(),
                                    row[column("force_z_n")].toDouble());
    constexpr double held_n = 0.1;
    if (force < held_n) continue;
    return {row[column("proxy_x_mm")].toDouble(), row[column("proxy_y_mm")].toDouble(),
            row[column("proxy_z_mm")].toDouble()};
  }
  throw std::runtime_error("nothing is felt along the stroke");
}

/// A ball of 25 mm about the origin.
void boundaries_are_drawn_where_they_are_felt() {
  scan_is_shown();
  for (const char* const name : {"Axial", "Sagittal", "Coronal"}) {
    wait_for(
        std::string("there are lines in ") + name, [&] { return drawn_in(name).size() > 100; }, 20);
    for (const Piece& piece : drawn_in(name)) {
      // The slices lie half a voxel beside the middle.
      expect(std::abs(radius_of(piece) - 25) < 0.4,
             std::string("the line lies on the ball in ") + name + ", not " + std::to_string(radius_of(piece)));
    }
  }
  const std::vector<Piece> axial = drawn_in("Axial");
  expect(axial.front().color == std::array<int, 3>{0xe6, 0x9f, 0x00}, "in the boundary's own color");
  save_screen("contours");

  // What the profile meets along a stroke is where the line is drawn.
  click("palpateProfileSectionFold");
  const double z = axial.front().middle[2];
  for (const auto& [field, x] : {std::pair{"palpateProfileFrom", -40}, {"palpateProfileTo", 0}}) {
    auto& line = find<QLineEdit>(field);
    line.setText(QStringLiteral("%1, 3, %2").arg(x).arg(z));
    emit line.editingFinished();
  }
  wait_for("the profile is there", [] { return label("palpateProfileReadout").contains("up to"); });
  const QString file = qEnvironmentVariable("PALPATE_PICTURES") + "/contours.csv";
  save_as("palpateProfileTable", file);
  const std::array<double, 3> held = first_held(file);
  double nearest = std::numeric_limits<double>::max();
  for (const Piece& piece : axial) {
    nearest = std::min(nearest, std::hypot(piece.middle[0] - held[0], piece.middle[1] - held[1]));
  }
  expect(nearest < 0.7, "it is felt where the line is: " + std::to_string(nearest) + " mm beside it");

  // A node of the gate is dragged, and the line follows before it is let go.
  click("palpateCurvesSectionFold");
  QWidget& gate = find<QWidget>("palpateGateCurveChart");
  scroll_to(find<QWidget>("palpateGateCurveValue"), gate);
  const double before = mean_radius(drawn_in("Axial"));
  const QPoint node(gate.width() / 3, gate.height() / 2);
  drag(gate, node, node + QPoint(-gate.width() / 5, -gate.height() / 3), false);
  wait_for(
      "the line goes where the node puts it",
      [&] {
        const std::vector<Piece> now = drawn_in("Axial");
        return !now.empty() && std::abs(mean_radius(now) - before) > 0.05;
      },
      20);
  save_screen("contours-dragged");
  let_go();

  find<QCheckBox>("palpateOn0").click();
  wait_for(
      "what is switched off is not drawn", [] { return drawn_in("Axial").empty(); }, 20);
  find<QCheckBox>("palpateOn0").click();
  wait_for(
      "and comes back", [] { return !drawn_in("Axial").empty(); }, 20);
  find<QCheckBox>("palpateContours").setChecked(false);
  wait_for(
      "lines can be put away", [] { return drawn_in("Sagittal").empty(); }, 20);
}

/// Pixels of a view's picture that have about that color.
int pixels_in(const char* name, const std::array<int, 3>& color) {
  const QImage seen = view(name).grab().toImage();
  int count = 0;
  for (int y = 0; y < seen.height(); ++y) {
    for (int x = 0; x < seen.width(); ++x) {
      const QColor at = seen.pixelColor(x, y);
      const int apart =
          std::abs(at.red() - color[0]) + std::abs(at.green() - color[1]) + std::abs(at.blue() - color[2]);
      count += apart < 60 ? 1 : 0;
    }
  }
  return count;
}

/// Wherever a slice and its camera are, its lines are in the picture.
void boundaries_are_seen_on_every_slice() {
  scan_is_shown();
  const auto expect_seen = [](const std::string& when) {
    for (const char* const name : {"Axial", "Sagittal", "Coronal"}) {
      wait_for(
          "lines are seen in " + std::string(name) + when,
          [&] {
            const auto lines = drawn_in(name);
            return lines.size() > 100 && pixels_in(name, lines.front().color) > 100;
          },
          20);
    }
  };
  expect_seen("");
  connect_stylus();
  expect_seen(" where the stylus is");
  for (const int steps : {2, -4, 3}) {
    for (const char* const name : {"Axial", "Sagittal", "Coronal"}) turn_wheel(name, steps);
    expect_seen(" after " + std::to_string(steps) + " slices");
  }
}

/// In every picture that is drawn while slices are leafed through: the lines that are seen are those of its slice.
void lines_are_of_the_slice_that_is_shown() {
  scan_is_shown();
  const auto height = [] {
    const QString place = place_text("Axial");  // "H 0.5 mm" and more
    const double mm = place.section(' ', 1, 1).toDouble();
    return place.startsWith('F') ? -mm : mm;
  };
  wait_for(
      "there are lines", [] { return drawn_in("Axial").size() > 100; }, 20);
  int pictures = 0, with_lines = 0, stale = 0;
  const palpate::plugin::EventWatch drawn(
      render_view("Axial").getRenderViewProxy()->GetRenderWindow(), vtkCommand::EndEvent, [&] {
        const std::vector<Piece> lines = drawn_in("Axial");
        ++pictures;
        with_lines += lines.empty() ? 0 : 1;
        const double at = height();
        stale += std::ranges::any_of(lines, [at](const Piece& line) { return std::abs(line.middle[2] - at) > 0.3; });
      });
  for (const int steps : {1, 1, 2, -3, 1, 4, -5}) {
    turn_wheel("Axial", steps);
    wait_for(
        "the lines come", [] { return drawn_in("Axial").size() > 100; }, 20);
  }
  expect(pictures > 7 && with_lines > 5, "pictures were drawn, with lines: " + std::to_string(with_lines));
  expect(stale == 0, "none has lines of another slice: " + std::to_string(stale) + " of " + std::to_string(pictures));
}

/// Both, in one picture: where the pointer is now, in the slice that is shown now.
void the_place_under_a_dragged_handle_is_told() {
  scan_is_shown();
  QWidget& axial = view("Axial");
  const QPoint from(axial.width() - 4, axial.height() / 2);
  const QString before = place_text("Axial");
  drag(axial, from, from + QPoint(0, -axial.height() / 4), false);
  wait_for(
      "the slice is another", [&] { return place_text("Axial") != before; }, 20);
  const auto number_after = [](const QString& text, const char* letters) {
    const QRegularExpressionMatch found =
        QRegularExpression(QStringLiteral("[%1] ?([0-9.]+)").arg(QLatin1String(letters))).match(text);
    expect(found.hasMatch(), "a place is told: " + text.toStdString());
    return found.captured(1).toDouble();
  };
  const double slice_mm = number_after(place_text("Axial"), "HF");
  const QString first = pointer_text("Axial");
  expect(std::abs(number_after(first, "HF") - slice_mm) < 0.6, "of the slice that is shown: " + first.toStdString());
  const double a_mm = number_after(first, "AP");
  // Straight up from the middle: towards the front.
  expect(a_mm > 5, "where the pointer is, and not where it was pressed: " + first.toStdString());
  let_go();
}

}  // namespace

const Scenarios& contour_scenarios() {
  static const Scenarios scenarios{
      {"boundaries_are_drawn_where_they_are_felt", boundaries_are_drawn_where_they_are_felt},
      {"lines_are_of_the_slice_that_is_shown", lines_are_of_the_slice_that_is_shown},
      {"the_place_under_a_dragged_handle_is_told", the_place_under_a_dragged_handle_is_told},
      {"boundaries_are_seen_on_every_slice", boundaries_are_seen_on_every_slice}};
  return scenarios;
}
