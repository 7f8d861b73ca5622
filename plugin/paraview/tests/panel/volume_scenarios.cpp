// The volume view: without the table, cropped by a box, and the boundaries as surfaces where they are felt.

#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <QAbstractButton>
#include <QAction>
#include <QComboBox>
#include <QImage>
#include <QPoint>
#include <QRect>
#include <QWidget>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plugin/paraview/client/views/caster.h"
#include "plugin/paraview/client/views/event_watch.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"
#include "plugin/paraview/tests/panel/volume_steps.h"

namespace {

/// Where the volume is seen, without the view's edges, where its texts, marks and frame are.
QRect seen_in(const QImage& picture) {
  QRect seen;
  const int edge = picture.height() / 8;
  for (int y = edge; y < picture.height() - edge; ++y) {
    for (int x = edge; x < picture.width() - edge; ++x) {
      if (picture.pixelColor(x, y).value() > 60) seen |= QRect(x, y, 1, 1);
    }
  }
  return seen;
}

QRect seen() {
  return seen_in(view("Volume").grab().toImage());
}

bool is_round(const QRect& of) {
  return of.width() > 20 && std::abs(of.width() - of.height()) < 0.12 * of.width();
}

/// Pixels of the skin's color in the volume view, from one row to another.
int of_skin(int top, int bottom) {
  const QImage picture = view("Volume").grab().toImage();
  int count = 0;
  for (int y = top; y < bottom; ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const QColor color = picture.pixelColor(x, y);
      count += color.red() > 60 && color.red() > 1.2 * color.blue() && color.green() > 0.6 * color.red() ? 1 : 0;
    }
  }
  return count;
}

/// In the middle of the handle's blue that is highest; nothing if none is seen.
std::optional<QPoint> highest_handle() {
  const QImage picture = view("Volume").grab().toImage();
  const int edge = 10;
  for (int y = edge; y < picture.height() - edge; ++y) {
    for (int x = edge; x < picture.width() - edge; ++x) {
      const QColor color = picture.pixelColor(x, y);
      const bool blue = color.blue() > 90 && color.blue() > 1.15 * color.green() && color.green() > 1.5 * color.red();
      if (blue) return QPoint(x, y + 4);
    }
  }
  return {};
}

/// A ball on a table.
void the_table_is_cut_away() {
  scan_is_shown();
  QAction& cut = action("palpateCutTable");
  wait_for("the table is found", [&] { return cut.isEnabled(); });
  expect(cut.isChecked(), "it is cut away at first");
  wait_for(
      "the ball alone is seen", [] { return is_round(seen()); }, 20);
  views_rest();
  const QRect ball = seen();
  save_screen("without-table");
  cut.trigger();
  wait_for(
      "the table is seen", [&] { return seen().width() > 1.3 * ball.width(); }, 20);
  save_screen("with-table");
  cut.trigger();
  wait_for(
      "and the ball alone again", [] { return is_round(seen()); }, 20);

  action("palpateCropBox").trigger();
  wait_for(
      "there is a handle", [] { return highest_handle().has_value(); }, 20);
  views_rest();
  save_screen("crop-box");
  const QPoint handle = *highest_handle();
  const int whole_top = of_skin(ball.top(), ball.center().y()), whole_low = of_skin(ball.center().y(), ball.bottom());
  drag(view("Volume"), handle, handle + QPoint(0, ball.height() * 2 / 5), true);
  int top = 0, low = 0;
  const bool is_cropped = comes_true([&] {
    top = of_skin(ball.top(), ball.center().y());
    low = of_skin(ball.center().y(), ball.bottom());
    return top < whole_top * 7 / 10 && low > whole_low * 9 / 10;
  });
  save_screen("cropped");
  expect(is_cropped, "what is above the box is cut away: " + std::to_string(top) + " of " + std::to_string(whole_top) +
                         ", and what is in it stays: " + std::to_string(low) + " of " + std::to_string(whole_low));
  action("palpateCropBox").trigger();
  wait_for(
      "without the box all of it is there", [] { return is_round(seen()); }, 20);
}

struct Surface {
  double least_mm = 1e9, most_mm = 0;  // from the origin
  double opacity = 0;
  QColor color;
};

Surface surface_seen() {
  Surface seen;
  vtkActorCollection& actors = *volume_renderer().GetActors();
  for (int n = 0; n < actors.GetNumberOfItems(); ++n) {
    auto* const actor = vtkActor::SafeDownCast(actors.GetItemAsObject(n));
    auto* const mapper = vtkPolyDataMapper::SafeDownCast(actor->GetMapper());
    vtkPolyData* const shape = mapper ? mapper->GetInput() : nullptr;
    if (!shape || shape->GetNumberOfPolys() < 500 || !actor->GetVisibility()) continue;
    for (vtkIdType point = 0; point < shape->GetNumberOfPoints(); ++point) {
      double at[3];
      shape->GetPoint(point, at);
      const double radius = std::hypot(at[0], at[1], at[2]);
      seen.least_mm = std::min(seen.least_mm, radius);
      seen.most_mm = std::max(seen.most_mm, radius);
    }
    seen.opacity = actor->GetProperty()->GetOpacity();
    const double* const color = actor->GetProperty()->GetColor();
    const auto byte = [](double part) { return static_cast<int>(std::lround(255 * part)); };
    seen.color = QColor(byte(color[0]), byte(color[1]), byte(color[2]));
  }
  return seen;
}

/// A ball of 25 mm about the origin.
void surfaces_are_seen_where_they_are_felt() {
  scan_is_shown();
  wait_for(
      "the scan is drawn at first", [] { return scan_is_drawn(volume_renderer()); }, 20);
  auto& looks = find<QComboBox>("palpateVolumeLook");
  const auto choose = [&](int look) {
    looks.setCurrentIndex(look);
    emit looks.activated(look);
  };
  choose(looks.count() - 1);
  expect(looks.currentText() == "Felt boundaries", "it is the last of the looks");
  wait_for(
      "the surface is there", [] { return surface_seen().most_mm > 0; }, 20);
  const Surface felt = surface_seen();
  // A quarter of a voxel: the value is met between the voxels.
  expect(std::abs(felt.least_mm - 25) < 0.5 && std::abs(felt.most_mm - 25) < 0.5,
         "it is the ball's: " + std::to_string(felt.least_mm) + " to " + std::to_string(felt.most_mm) + " mm");
  expect(felt.color == QColor(0xe6, 0x9f, 0x00), "in the boundary's color: " + felt.color.name().toStdString());
  expect(felt.opacity > 0.5 && felt.opacity < 1, "seen through a little");
  expect(!scan_is_drawn(volume_renderer()), "nothing hides it");
  views_rest();
  const QImage picture = view("Volume").grab().toImage();
  const QColor middle = picture.pixelColor(seen_in(picture).center());
  expect(std::abs(middle.hue() - 41) < 12, "it is orange in the picture: " + middle.name().toStdString());
  save_screen("felt-surfaces");
  find<QAbstractButton>("palpateOn0").click();
  wait_for(
      "what is switched off is not drawn", [] { return surface_seen().most_mm == 0; }, 20);
  find<QAbstractButton>("palpateOn0").click();
  wait_for(
      "and comes back", [] { return surface_seen().most_mm > 0; }, 20);
  choose(0);
  wait_for(
      "another look shows the scan", [] { return scan_is_drawn(volume_renderer()) && surface_seen().most_mm == 0; },
      20);
}

/// Colors and opacity of the volume, as its representation has them.
std::vector<double> volume_colors() {
  vtkSMProxy& shown = *reader().getRepresentation(&render_view("Volume"))->getProxy();
  std::vector<double> numbers;
  for (const auto& [function, property] :
       {std::pair{"LookupTable", "RGBPoints"}, {"ScalarOpacityFunction", "Points"}}) {
    vtkSMProxy* const of = vtkSMPropertyHelper(&shown, function).GetAsProxy();
    const std::vector<double> points = vtkSMPropertyHelper(of, property).GetDoubleArray();
    numbers.insert(numbers.end(), points.begin(), points.end());
  }
  numbers.push_back(vtkSMPropertyHelper(&shown, "Shade").GetAsInt());
  return numbers;
}

/// Two scans in a folder; the boundaries of the first are shown as surfaces when the second comes.
void a_look_is_of_its_scan() {
  choose_series(0);
  auto& looks = find<QComboBox>("palpateVolumeLook");
  const QString first_look = looks.currentText();
  const std::vector<double> first = volume_colors();
  looks.setCurrentIndex(looks.count() - 1);
  emit looks.activated(looks.count() - 1);
  wait_for(
      "the surface is there", [] { return surface_seen().most_mm > 0; }, 20);
  expect(volume_colors() == first, "the scan's own picture stays as it is until then");
  choose_series(1);
  views_rest();
  save_screen("look-of-the-second");
  expect(looks.currentText() == first_look, "the second has a look of its own: " + looks.currentText().toStdString());
  expect(volume_colors() == first, "and that look's colors");
  expect(surface_seen().most_mm == 0, "no surfaces are seen");
  wait_for(
      "the scan is drawn", [] { return scan_is_drawn(volume_renderer()); }, 20);
}

QString saved_state(const char* name) {
  const QString file = qEnvironmentVariable("PALPATE_PICTURES") + QLatin1Char('/') + QLatin1String(name);
  expect(pqApplicationCore::instance()->saveState(file), std::string("the state is saved: ") + name);
  return file;
}

/// A preset is in the colors that ParaView keeps; that the felt boundaries are shown is not.
void a_look_comes_back_with_its_state() {
  scan_is_shown();
  const auto choose = [](const char* look) {
    auto& looks = find<QComboBox>("palpateVolumeLook");
    looks.setCurrentText(QLatin1String(look));
    emit looks.activated(looks.currentIndex());
  };
  const auto expect_look = [](const char* look) {
    const QString now = find<QComboBox>("palpateVolumeLook").currentText();
    expect(now == look, std::string("the box says ") + look + ", not " + now.toStdString());
  };
  choose("CT bone");
  const std::vector<double> bone = volume_colors();
  const QString as_bone = saved_state("look-bone.pvsm");
  choose("CT skin");
  choose("Felt boundaries");
  wait_for(
      "the surface is there", [] { return surface_seen().most_mm > 0; }, 20);
  const QString as_felt = saved_state("look-felt.pvsm");
  load_state(as_bone);
  expect_look("CT bone");
  expect(volume_colors() == bone && surface_seen().most_mm == 0, "it is shown so");
  wait_for(
      "the scan is drawn", [] { return scan_is_drawn(volume_renderer()); }, 20);
  load_state(as_felt);
  expect_look("Felt boundaries");
  wait_for(
      "the surface is there again", [] { return surface_seen().most_mm > 0 && !scan_is_drawn(volume_renderer()); }, 20);
  save_screen("look-restored");
  const unsigned before = reader_in_pipeline();
  drop_folder(qEnvironmentVariable("PALPATE_OPEN"));
  another_scan_is_shown(before);
  expect_look("CT skin");
  expect(surface_seen().most_mm == 0, "a scan that is opened has its own look");
}

/// In pixels of the view's picture, from the left and from above.
QPoint origin_in_volume_view() {
  double x = 0, y = 0, z = 0;
  volume_renderer().WorldToView(x, y, z);
  const QWidget& in = view("Volume");
  return QPoint(static_cast<int>((x + 1) / 2 * in.width()), static_cast<int>((1 - y) / 2 * in.height()));
}

/// The same without the quarters at the sides, where the orientation marker is.
QRect seen_in_the_middle() {
  const QImage picture = view("Volume").grab().toImage();
  const QRect middle(picture.width() / 4, 0, picture.width() / 2, picture.height());
  return seen_in(picture.copy(middle)).translated(middle.topLeft());
}

/// A ball of 25 mm about the origin, scanned obliquely.
void the_volume_lies_in_the_patient() {
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  scan_is_shown();
  wait_for(
      "the ball is seen", [] { return is_round(seen_in_the_middle()); }, 20);
  views_rest();
  const QRect ball = seen_in_the_middle();
  const QPoint off = ball.center() - origin_in_volume_view();
  save_screen("oblique-volume");
  expect(std::hypot(off.x(), off.y()) < 0.06 * ball.width(),
         "its middle is the patient's origin: " + std::to_string(off.x()) + ", " + std::to_string(off.y()) +
             " pixels off, it is " + std::to_string(ball.width()) + " wide");
  // As the eye in the pipeline browser does.
  pqDataRepresentation* const shown = reader().getRepresentation(&render_view("Volume"));
  shown->setVisible(false);
  wait_for("what is hidden is not drawn", [] { return !is_round(seen_in_the_middle()); });
  shown->setVisible(true);
  wait_for("it is drawn again", [] { return is_round(seen_in_the_middle()); });
}

}  // namespace

const Scenarios& volume_scenarios() {
  static const Scenarios scenarios{{"the_table_is_cut_away", the_table_is_cut_away},
                                   {"the_volume_lies_in_the_patient", the_volume_lies_in_the_patient},
                                   {"a_look_is_of_its_scan", a_look_is_of_its_scan},
                                   {"a_look_comes_back_with_its_state", a_look_comes_back_with_its_state},
                                   {"surfaces_are_seen_where_they_are_felt", surfaces_are_seen_where_they_are_felt}};
  return scenarios;
}
