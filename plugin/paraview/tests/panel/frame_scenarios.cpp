// Frames, filters and flow: the views and the stylus have the same values.

#include <pqActiveObjects.h>
#include <pqAnimationManager.h>
#include <pqAnimationScene.h>
#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqPVApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqServer.h>
#include <pqServerManagerModel.h>
#include <pqTimeKeeper.h>
#include <pqUndoStack.h>
#include <vtkAlgorithm.h>
#include <vtkImageData.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <QAction>
#include <QCheckBox>
#include <QColor>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QImage>
#include <QListWidget>
#include <QObject>
#include <QProgressBar>
#include <QPushButton>
#include <QRegularExpression>
#include <QSlider>

#include <cmath>
#include <stdexcept>
#include <string>

#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/tests/panel/drawn_lines.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// The row of the list whose text has these words.
int row_with(const QString& words) {
  auto& series = find<QListWidget>("palpateSeries");
  wait_for("the series are listed", [&] { return series.count() > 1; });
  for (int row = 0; row < series.count(); ++row) {
    if (series.item(row)->text().contains(words)) return row;
  }
  throw std::runtime_error("no series is listed with " + words.toStdString());
}

/// The free stream of the phantom goes up and down by half of itself in five times of a cycle.
double stream_at(int time) {
  constexpr double pulsation = 0.5, pi = 3.14159265358979;
  return 1 + pulsation * std::sin(2 * pi * time / 5);
}

bool is_near(double a, double b, double part) {
  return std::abs(a - b) <= part * std::abs(b);
}

/// Whoever drives the time, views and stylus have the same frame: slider, ParaView's own buttons, ParaView's time.
void frames_are_felt_as_shown() {
  choose_series(row_with("velocity of"));
  expect(find<QSlider>("palpateFrame").maximum() == 4, "there are five frames to slide over");
  click("palpateConnect");
  stylus_rests();
  // To a place in the stream, off the sphere: by the mouse, without a force.
  QWidget& sagittal = view("Sagittal");
  const QPoint from = proxy_in(sagittal);
  drag(sagittal, from, QPoint(sagittal.width() / 3, sagittal.height() / 3), true);
  stylus_rests();
  const double felt_first = steady_number("palpateTissue");
  expect(felt_first > 0, "the stylus is in the stream: " + label("palpateTissue").toStdString());
  turn_wheel("Axial", 0);  // the pointer in the middle of it
  const auto expect_frame = [&](int frame, const std::string& by) {
    wait_for(
        by + " leads to frame " + std::to_string(frame + 1),
        [&] {
          return label("palpateFrameText").endsWith(QStringLiteral("%1 of 5").arg(frame + 1)) &&
                 label("palpateFelt").contains(QStringLiteral("%1 of 5.").arg(frame + 1)) &&
                 place_text("Axial").endsWith(QStringLiteral("%1 of 5").arg(frame + 1)) &&
                 find<QSlider>("palpateFrame").value() == frame;
        },
        20);
    wait_for(
        by + ": what is felt is the frame's: " + label("palpateTissue").toStdString(),
        [&] { return is_near(number("palpateTissue") / felt_first, stream_at(frame) / stream_at(0), 0.04); }, 20);
  };
  const auto pqtime = [] { return pqActiveObjects::instance().activeServer()->getTimeKeeper()->getTime(); };
  const auto top_speed = [] { return find<QDoubleSpinBox>("palpateStrengthCurveAt").maximum(); };
  const double first_speed = top_speed();
  find<QSlider>("palpateFrame").setValue(1);
  expect_frame(1, "the slider");
  wait_for("the curves have the frame's histogram", [&] { return top_speed() > 1.2 * first_speed; });
  expect(pqtime() == 1, "ParaView's time is the same");
  views_rest();
  const QImage faster = sagittal.grab().toImage();
  const int stream = qGray(faster.pixel(faster.width() / 4, faster.height() * 3 / 4));
  expect(stream > 60 && stream < 230, "a faster frame is neither black nor white: " + std::to_string(stream));
  save_screen("frame-2");
  QWidget& window = *pqCoreUtilities::mainWidget();
  const QRect wide = window.geometry();
  window.setGeometry(wide.x(), wide.y(), 700, wide.height());
  wait_for(
      "a long name is shortened in a narrow view",
      [] { return place_text("Axial").contains(QStringLiteral("…")) && place_text("Axial").endsWith("2 of 5"); }, 20);
  save_screen("frame-narrow");
  window.setGeometry(wide);
  wait_for(
      "and whole in a wide one", [] { return !place_text("Axial").contains(QStringLiteral("…")); }, 20);
  const auto trigger = [](const char* action) {
    auto* const found = pqCoreUtilities::mainWidget()->findChild<QAction*>(QString::fromLatin1(action));
    expect(found != nullptr, std::string("ParaView has ") + action);
    found->trigger();
  };
  trigger("actionVCRLastFrame");
  expect_frame(4, "ParaView's Last");
  trigger("actionVCRPreviousFrame");
  expect_frame(3, "ParaView's Back");
  trigger("actionVCRFirstFrame");
  expect_frame(0, "ParaView's First");
  click("palpateFrameLast");
  expect_frame(4, "the panel's Last");
  expect(pqtime() == 4, "ParaView's time is the last");
  pqPVApplicationCore::instance()->animationManager()->getActiveScene()->setAnimationTime(2);
  expect_frame(2, "ParaView's time");
  // While it is felt the force goes over in a ramp, and the stylus stays.
  turn_forces_on();
  find<QSlider>("palpateFrame").setValue(1);
  expect_frame(1, "the slider");
  expect(label("palpateState").startsWith("Feeling") || label("palpateState").startsWith("Stopped: The"),
         "another frame takes no force away");
  // Another series begins at its first frame.
  find<QPushButton>("palpateRelease").click();
  choose_series(row_with("magnitude"));
  expect(pqtime() == 0 && find<QSlider>("palpateFrame").value() == 0, "another series: the time starts anew");
  save_screen("frames-magnitude");
}

/// Standard deviation of the shown values in a corner of the scan, where the phantom is air.
double shown_noise() {
  auto* const image = vtkImageData::SafeDownCast(
      vtkAlgorithm::SafeDownCast(reader().getProxy()->GetClientSideObject())->GetOutputDataObject(0));
  expect(image != nullptr, "the reader has an image");
  double sum = 0, squares = 0, count = 0;
  for (int k = 4; k < 12; ++k) {
    for (int j = 4; j < 12; ++j) {
      for (int i = 4; i < 12; ++i) {
        const double value = image->GetScalarComponentAsDouble(i, j, k, 0);
        sum += value;
        squares += value * value;
        ++count;
      }
    }
  }
  return std::sqrt(squares / count - (sum / count) * (sum / count));
}

/// The value under the proxy, once the stylus rests and what it feels has come.
double steady_value() {
  wait_for(
      "a value is under the proxy", [] { return label("palpateTissue").contains("HU"); }, 20);
  return steady_number("palpateTissue");
}

/// The row, the scene, what is shown and what is felt have the same filter; undo takes it away from all of them.
void a_filter_is_felt_and_shown() {
  scan_is_shown();
  click("palpateConnect");
  const double raw_noise = shown_noise();
  const double raw_felt = steady_value();
  expect(raw_noise > 60 && raw_noise < 100, "the noise is the phantom's: " + std::to_string(raw_noise));
  auto& type = find<QComboBox>("palpateFilter");
  if (!type.isVisible()) click("palpateScanSectionFold");
  scroll_to(type);
  type.setCurrentIndex(type.findText("Gaussian"));
  emit type.activated(type.currentIndex());
  wait_for(
      "the filter is felt", [] { return label("palpateFelt").contains("Gaussian filter of 1 mm"); }, 20);
  expect(scene_text().find("\"filter\"") != std::string::npos, "the scene has the filter");
  // White noise through a Gaussian of one voxel: 1 / (2 sqrt(pi)) of the variance along each axis.
  const double left = std::pow(1 / (2 * std::sqrt(3.14159265358979)), 1.5);
  expect(is_near(shown_noise() / raw_noise, left, 0.25), "the shown noise is less: " + std::to_string(shown_noise()));
  const double felt = steady_value();
  save_screen("filter-gaussian");
  expect(felt != raw_felt && std::abs(felt + 1000) < 4 * left * raw_noise, "the felt value is air's without noise");
  // Felt and not shown: it is said, and what is felt stays.
  click("palpateFilterShown");
  wait_for(
      "it is said",
      [] { return label("palpateFelt").contains("Gaussian filter of 1 mm (the views show unfiltered values)"); }, 20);
  expect(shown_noise() == raw_noise, "the raw values are shown");
  constexpr double trembling_hu = 10;
  expect(std::abs(steady_value() - felt) < trembling_hu, "what is felt stays");
  click("palpateFilterShown");
  wait_for(
      "the filtered values are shown", [&] { return shown_noise() < raw_noise / 2; }, 20);
  turn_forces_on();
  find<QDoubleSpinBox>("palpateFilterAmount").setValue(2);
  wait_for(
      "another width is felt", [] { return label("palpateFelt").contains("Gaussian filter of 2 mm"); }, 20);
  expect(forces_are_on(), "another filter takes no force away");
  // Undo returns at once, as the first choice does; what it brings back is computed meanwhile.
  pqApplicationCore::instance()->getUndoStack()->undo();
  expect(find<QProgressBar>("palpateFiltering").isVisible(), "undo computes in the background");
  expect(type.isVisible() && find<QDoubleSpinBox>("palpateFilterAmount").value() == 1, "the row says what comes");
  wait_for(
      "the first width is felt again", [] { return label("palpateFelt").contains("Gaussian filter of 1 mm"); }, 20);
  expect(!find<QProgressBar>("palpateFiltering").isVisible(), "it is there");
  expect(forces_are_on(), "undo takes no force away");
  // Two steps, the second while the first is on its way.
  pqApplicationCore::instance()->getUndoStack()->redo();
  pqApplicationCore::instance()->getUndoStack()->undo();
  pqApplicationCore::instance()->getUndoStack()->undo();
  wait_for(
      "undo takes the filter away", [] { return !label("palpateFelt").contains("filter"); }, 20);
  expect(scene_text().find("\"filter\"") == std::string::npos, "the scene has no filter");
  expect(type.currentText() == "None", "the row says so");
  wait_for(
      "the raw values are shown", [&] { return shown_noise() == raw_noise; }, 20);
  // With its force on the stylus may have moved a little, and the noise with it.
  expect(std::abs(steady_value() - raw_felt) < raw_noise / 2, "the raw values are felt");
}

void a_flow_is_shown_and_felt() {
  choose_series(row_with("velocity of"));
  expect(scene_text().find("\"follow\"") != std::string::npos, "the scene is of flow");
  expect(find<QCheckBox>("palpateOn0").isChecked(), "its modes can be switched");
  // Speeds, and how they change per mm, are small numbers: the curve's ends are not rounded to whole ones.
  wait_for("the curve's ends have decimals", [] {
    const QRegularExpression ends(QStringLiteral("m/s.*, ([0-9]+[.][0-9]{2})[^0-9]+([0-9]+[.][0-9]{2})[^0-9]"));
    const QRegularExpressionMatch match = ends.match(label("palpateStrengthCurveAxes").replace(QChar::Nbsp, ' '));
    return match.hasMatch() && match.captured(1).toDouble() < match.captured(2).toDouble();
  });
  auto& scenes = find<QComboBox>("palpateScenes");
  expect(scenes.currentText() == "Flow", "the scene was not found in it: " + scenes.currentText().toStdString());
  expect(scenes.itemData(0, Qt::ToolTipRole).toString().startsWith("No boundaries were found"), "and it is said why");
  save_screen("flow");
  connect_stylus();
  expect(number("palpateForce") < 0.05, "nothing is felt where it begins");
  QWidget& sagittal = view("Sagittal");
  const QPoint from = proxy_in(sagittal);
  drag(sagittal, from, QPoint(sagittal.width() / 3, sagittal.height() / 3), false);
  wait_for(
      "the flow pushes", [] { return number("palpateForce") > 0.05; }, 20);
  save_screen("flow-felt");
  let_go();
}

/// Part of the middle of the volume view in which something is seen.
double part_seen_of_volume() {
  const QImage picture = view("Volume").grab().toImage();
  const int width = picture.width() / 2, height = picture.height() / 2;
  int count = 0;
  for (int y = height / 2; y < height / 2 + height; ++y) {
    for (int x = width / 2; x < width / 2 + width; ++x) count += picture.pixelColor(x, y).value() > 60 ? 1 : 0;
  }
  return static_cast<double>(count) / (width * height);
}

/// The wind tunnel is a cube, whose sphere was not measured: that is not what the volume's colors are spread over.
void a_flow_is_drawn_as_a_volume() {
  choose_series(row_with("velocity of"));
  const auto wait_for_part = [](const std::string& what, double least, double most) {
    wait_for(
        what,
        [least, most] {
          const double part = part_seen_of_volume();
          return part >= least && part <= most;
        },
        20);
    views_rest();
  };
  const auto show_frame = [](int frame) {
    find<QSlider>("palpateFrame").setValue(frame);
    wait_for(
        "the frame is shown",
        [frame] { return place_text("Axial").endsWith(QStringLiteral("%1 of 5").arg(frame + 1)); }, 20);
  };
  wait_for_part("the cube is seen", 0.3, 1);
  save_screen("flow-volume");
  show_frame(1);
  wait_for_part("it is faster and seen", 0.3, 1);
  // Speeds are compared: the colors stay those of the first frame.
  show_frame(4);
  wait_for_part("what is half as fast is seen beside the sphere alone", 0, 0.1);
  show_frame(0);
  wait_for_part("the first frame is seen again", 0.3, 1);
}

/// A ball of 25 mm, and of 23 mm in the second frame: surfaces of the first are not seen while the second's are made.
void surfaces_are_of_the_frame_that_is_shown() {
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  scan_is_shown();
  auto& looks = find<QComboBox>("palpateVolumeLook");
  looks.setCurrentText("Felt boundaries");
  emit looks.activated(looks.currentIndex());
  const auto radius_mm = [] { return -least_of_surface_in("Volume", QColor(0xe6, 0x9f, 0x00)).x; };
  wait_for(
      "the first frame's surface is there", [&] { return std::abs(radius_mm() - 25) < 0.7; }, 20);
  // The slot of the action stands for one of the panel's: that the second frame is felt is told at once.
  QAction felt;
  QObject::connect(&panel_session(), SIGNAL(felt_scan_changed()), &felt, SLOT(trigger()));
  double radius_when_felt_mm = -1;
  QObject::connect(&felt, &QAction::triggered, [&] { radius_when_felt_mm = radius_mm(); });
  find<QSlider>("palpateFrame").setValue(1);
  wait_for(
      "the second frame is felt", [] { return label("palpateFelt").contains("2 of 2."); }, 20);
  expect(radius_when_felt_mm == 0,
         "the first frame's surface is gone by then: " + std::to_string(radius_when_felt_mm) + " mm");
  wait_for(
      "the second frame's surface is there", [&] { return std::abs(radius_mm() - 23) < 0.7; }, 20);
  save_screen("frame-surfaces");
}

/// Refused before anything is connected, in words, and the scene that can be felt stays.
void a_scene_without_its_field_is_refused() {
  scan_is_shown();
  const std::string before = scene_text();
  auto& scenes = find<QComboBox>("palpateScenes");
  const QString named = scenes.currentText();
  const int flow = scenes.findText("Flow");
  expect(flow > 0, "Flow is offered");
  scenes.setCurrentIndex(flow);
  emit scenes.activated(flow);
  wait_for(
      "it is refused in words",
      [] {
        return label("palpateSceneMessage") ==
               "the scene \"Flow\" cannot be felt on this scan, which has no vector field: open a velocity field "
               "(phase "
               "contrast), or choose another scene";
      },
      20);
  expect(scene_text() == before, "the scene in the pipeline is the one that can be felt");
  expect(scenes.currentText() == named, "and the box says so");
  save_screen("scene-refused");
  // Also where somebody else puts it into the pipeline.
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source->getProxy()->GetXMLName() != std::string("PalpateScene")) continue;
    vtkSMPropertyHelper(source->getProxy(), "Scene").Set("flow");
    source->getProxy()->UpdateVTKObjects();
  }
  wait_for(
      "what is refused does not stay in the pipeline", [&] { return scene_text() == before; }, 20);
  connect_stylus();
  press();
}

}  // namespace

const Scenarios& frame_scenarios() {
  static const Scenarios all{
      {"a_filter_is_felt_and_shown", a_filter_is_felt_and_shown},
      {"frames_are_felt_as_shown", frames_are_felt_as_shown},
      {"a_flow_is_shown_and_felt", a_flow_is_shown_and_felt},
      {"a_flow_is_drawn_as_a_volume", a_flow_is_drawn_as_a_volume},
      {"surfaces_are_of_the_frame_that_is_shown", surfaces_are_of_the_frame_that_is_shown},
      {"a_scene_without_its_field_is_refused", a_scene_without_its_field_is_refused},
  };
  return all;
}
