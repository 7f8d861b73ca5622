// What is shown is what is felt: where it is not, there is no force, and the panel says why.

#include <pqActiveObjects.h>
#include <pqAnimationManager.h>
#include <pqAnimationScene.h>
#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqDataRepresentation.h>
#include <pqDeleteReaction.h>
#include <pqObjectBuilder.h>
#include <pqPVApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <pqServer.h>
#include <pqServerManagerModel.h>
#include <pqTimeKeeper.h>
#include <pqUndoStack.h>
#include <vtkAlgorithm.h>
#include <vtkImageData.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <QAction>
#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QListWidget>
#include <QPushButton>
#include <QRegularExpression>
#include <QSlider>

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

pqPipelineSource& reader() {
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source->getProxy()->GetXMLName() == std::string("PalpateDicomReader")) return *source;
  }
  throw std::runtime_error("there is no scan in the pipeline");
}

/// Another number for another reader; 0: none.
unsigned reader_in_pipeline() {
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source->getProxy()->GetXMLName() == std::string("PalpateDicomReader")) return source->getProxy()->GetGlobalID();
  }
  return 0;
}

void choose_series(int row) {
  const unsigned before = reader_in_pipeline();
  auto& series = find<QListWidget>("palpateSeries");
  wait_for("the series are listed", [&] { return series.count() > row; });
  scroll_to(series);
  series.scrollToItem(series.item(row));
  click(*series.viewport(), series.visualItemRect(series.item(row)).center());
  wait_for("another scan is in the pipeline",
           [&] { return reader_in_pipeline() != 0 && reader_in_pipeline() != before; });
  scan_is_shown();
}

/// The force goes, the state says `why`, and Feel stays off.
void expect_stopped(const char* why) {
  wait_for(
      std::string("it is stopped: ") + why,
      [&] { return label("palpateState").startsWith("Stopped: ") && label("palpateState").contains(why); }, 20);
  wait_for(
      "the force is gone", [] { return number("palpateForce") == 0; }, 5);
  wait_ms(500);
  expect(number("palpateForce") == 0, "the force stays away");
  expect(!find<QPushButton>("palpateFeel").isEnabled() || find<QPushButton>("palpateFeel").text() == "Clear fault",
         "Feel cannot be pressed");
}

/// Nothing turns the force on by itself; Feel does.
void expect_ready_to_feel() {
  if (find<QPushButton>("palpateFeel").text() == "Clear fault") click("palpateFeel");
  wait_for(
      "it is ready", [] { return label("palpateState").startsWith("Ready: no force"); }, 20);
  wait_ms(700);
  expect(number("palpateForce") == 0, "no force came by itself");
  turn_forces_on();
}

void set_scan_visible(bool visible) {
  for (pqDataRepresentation* const shown : reader().getRepresentations(nullptr)) {
    shown->setVisible(visible);
    if (shown->getView()) shown->getView()->render();
  }
}

void no_scan_shown_no_force() {
  choose_series(0);
  feel();
  expect(label("palpateFelt").startsWith("Felt: CT "), "the panel names what is felt");
  save_screen("felt-named");
  set_scan_visible(false);
  expect_stopped("no view shows the scan. Show it again (the eye in the Pipeline Browser), then press Feel");
  save_screen("no-scan-hidden");
  let_go();
  set_scan_visible(true);
  expect_ready_to_feel();

  // A second scan is active in the pipeline, and seen in a view.
  press();
  pqObjectBuilder& builder = *pqApplicationCore::instance()->getObjectBuilder();
  pqPipelineSource& first = reader();
  pqPipelineSource* const second =
      builder.createSource("sources", "PalpateDicomReader", pqActiveObjects::instance().activeServer());
  vtkSMPropertyHelper(second->getProxy(), "FileName")
      .Set(vtkSMPropertyHelper(first.getProxy(), "FileName").GetAsString());
  second->getProxy()->UpdateVTKObjects();
  second->updatePipeline();
  pqActiveObjects::instance().setActiveSource(second);
  expect_stopped("another scan, ");
  expect_stopped(", is active in the Pipeline Browser. Choose ");
  expect_stopped(" there, then press Feel");
  let_go();
  pqDataRepresentation* const also =
      builder.createDataRepresentation(second->getOutputPort(0), pqActiveObjects::instance().activeView());
  also->setVisible(true);
  wait_for(
      "it is said which one is not felt",
      [&] { return label("palpateFelt").endsWith("Also shown, not felt: " + second->getSMName() + "."); }, 10);
  save_screen("second-scan");
  pqActiveObjects::instance().setActiveSource(&first);
  expect_ready_to_feel();
  builder.destroy(second);
  wait_ms(500);

  // The reader is deleted in mid-contact.
  press();
  builder.destroy(&first);
  expect_stopped("the scan is no longer in the pipeline. Open a scan, then press Feel");
  expect(find<QPushButton>("palpateConnect").text() == "Disconnect", "the stylus is still connected");
  save_screen("no-scan-deleted");
  let_go();
  choose_series(1);
  expect_ready_to_feel();
}

void a_reset_session_has_no_force() {
  feel();
  pqDeleteReaction::deleteAll();
  expect_stopped("Open a scan, then press Feel");
  save_screen("no-scan-reset");
  let_go();
  wait_for("ParaView has a session again", [] { return pqActiveObjects::instance().activeServer() != nullptr; });
  wait_ms(1000);
  expect(label("palpateFelt") == "No scan is open.", "nothing is said to be felt");
  drop_folder(qEnvironmentVariable("PALPATE_OPEN"));
  scan_is_shown();
  expect_ready_to_feel();
  // And where ParaView goes to another session altogether.
  press();
  pqApplicationCore::instance()->getObjectBuilder()->removeServer(pqActiveObjects::instance().activeServer());
  expect_stopped("Open a scan, then press Feel");
  let_go();
}

void a_loaded_state_has_no_force() {
  scan_is_shown();
  find<QDoubleSpinBox>("palpateStrength0").setValue(0.45);
  wait_ms(500);
  const std::string saved = scene_text();
  const QString file = qEnvironmentVariable("PALPATE_PICTURES") + QStringLiteral("/panel-shown.pvsm");
  expect(pqApplicationCore::instance()->saveState(file), "the state is saved");
  find<QDoubleSpinBox>("palpateStrength0").setValue(0.9);
  connect_stylus();
  press();
  pqApplicationCore::instance()->loadState(file.toUtf8().constData(), pqActiveObjects::instance().activeServer());
  wait_for(
      "the force is gone", [] { return number("palpateForce") == 0; }, 5);
  let_go();
  wait_for("the scene is the state's", [&] { return scene_text() == saved || !scene_text().empty(); });
  scan_is_shown();
  expect(find<QPushButton>("palpateConnect").text() == "Disconnect", "the stylus is still connected");
  expect(find<QDoubleSpinBox>("palpateStrength0").value() == 0.45, "the panel has the state's scene");
  expect(label("palpateFelt").contains("Scene: Restored with the state."), "it is said where the scene is from");
  save_screen("state-loaded");
  expect_ready_to_feel();
}

/// What was done to one scan's scene is not undone on another's.
void undo_belongs_to_a_scan() {
  choose_series(0);
  expect(find<QComboBox>("palpateScenes").currentText() == "Found in this scan", "the scene was found in the scan");
  find<QDoubleSpinBox>("palpateStrength0").setValue(0.65);
  wait_for(
      "the scene says that it was edited",
      [] { return find<QComboBox>("palpateScenes").currentText() == "Found in this scan, edited"; }, 5);
  click("palpateCurvesSectionFold");
  click("palpateUndo");
  wait_for(
      "undone, it is what was found",
      [] { return find<QComboBox>("palpateScenes").currentText() == "Found in this scan"; }, 5);
  click("palpateRedo");
  wait_for(
      "done again", [] { return find<QComboBox>("palpateScenes").currentText() == "Found in this scan, edited"; }, 5);
  const std::string first = scene_text();
  choose_series(1);
  const std::string second = scene_text();
  expect(second != first, "the other scan has a scene of its own");
  const bool can = find<QWidget>("palpateUndo").isEnabled();
  if (can) click("palpateUndo");
  wait_ms(800);
  expect(scene_text() == second, "the first scan's scene does not come to the second");
  expect(find<QComboBox>("palpateScenes").currentText() == "Found in this scan", "and it is the one found in it");
  // A file's scene is called by the file, and leaves the reach as it is.
  const QString file = qEnvironmentVariable("PALPATE_PICTURES") + QStringLiteral("/my scene.json");
  find<QDoubleSpinBox>("palpateStrength0").setValue(0.7);
  wait_ms(300);
  save_as("palpateSaveScene", file);
  click("palpateOneToOne");
  wait_ms(300);
  const QString reach = label("palpateScale");
  name_file("palpateOpenScene", file);
  wait_for(
      "the scene is called by its file",
      [] { return find<QComboBox>("palpateScenes").currentText() == "my scene.json"; }, 5);
  expect(label("palpateScale") == reach, "the reach is the user's");
  save_screen("scene-named");
  // With a stylus connected, another series gets a scene that says what it is.
  connect_stylus();
  choose_series(0);
  expect(find<QComboBox>("palpateScenes").currentText() != "my scene.json", "the file's scene was another scan's");
  expect(label("palpateFelt").contains("Scene: " + find<QComboBox>("palpateScenes").currentText()),
         "the footer names the same");
}

/// Ready at a place that is seen in every view, in air, without a force.
void expect_begins_in_sight() {
  click("palpateConnect");
  wait_for(
      "it is ready", [] { return label("palpateState").startsWith("Ready: no force"); }, 20);
  wait_ms(1500);
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
  wait_ms(300);
  const QString reach = label("palpateScale");
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
  for (pqRenderView* const one : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>()) {
    if (one->getSMName() == QLatin1String("Coronal")) pqActiveObjects::instance().setActiveView(one);
  }
  connect_stylus();
  QWidget& coronal = view("Coronal");
  auto& stiffness = find<QDoubleSpinBox>("palpateStiffness");
  const double before = stiffness.value();
  move_pointer(find<QWidget>("palpateFeel"), QPoint(5, 5));  // where it was when Feel was clicked
  wait_ms(500);
  const QPoint at = proxy_in(coronal);
  for (int n = 0; n < 8; ++n) type_key("Up");
  wait_for(
      "the stylus goes up", [&] { return proxy_in(coronal).y() < at.y() - 4; }, 10);
  expect(stiffness.value() == before, "no number has changed");
  // A number that is clicked takes them, until another button is clicked.
  scroll_to(stiffness);
  click(stiffness, QPoint(20, stiffness.height() / 2));
  type_key("Up");
  wait_for(
      "the number that was clicked has changed", [&] { return stiffness.value() == before + stiffness.singleStep(); },
      5);
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
  wait_ms(800);
  const int through = slice_number("Axial");
  turn_wheel("Axial", 6);
  const int leafed = slice_number("Axial");
  expect(std::abs(leafed - through) == 6, "the wheel leafs");
  press_key_in(view("Coronal"), "Right");
  wait_ms(1500);
  expect(slice_number("Axial") == leafed, "the slice stays, though the stylus moves");
  save_screen("leafed");
  click("palpateGoToStylus");
  wait_for(
      "Go to stylus leads back", [&] { return slice_number("Axial") == through; }, 5);
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
  wait_ms(1500);
  // To a place in the stream, off the sphere: by the mouse, without a force.
  QWidget& sagittal = view("Sagittal");
  const QPoint from = proxy_in(sagittal);
  drag(sagittal, from, QPoint(sagittal.width() / 3, sagittal.height() / 3), true);
  wait_ms(2500);
  const double felt_first = number("palpateTissue");
  expect(felt_first > 0, "the stylus is in the stream: " + label("palpateTissue").toStdString());
  turn_wheel("Axial", 0);  // the pointer in the middle of it
  const auto expect_frame = [&](int frame, const std::string& by) {
    wait_for(
        by + " leads to frame " + std::to_string(frame + 1),
        [&] {
          return label("palpateFrameText").endsWith(QStringLiteral("%1 of 5").arg(frame + 1)) &&
                 label("palpateFelt").contains(QStringLiteral("%1 of 5.").arg(frame + 1)) &&
                 find<QSlider>("palpateFrame").value() == frame;
        },
        20);
    wait_for(
        by + ": what is felt is the frame's: " + label("palpateTissue").toStdString(),
        [&] { return is_near(number("palpateTissue") / felt_first, stream_at(frame) / stream_at(0), 0.04); }, 10);
  };
  const auto pqtime = [] { return pqActiveObjects::instance().activeServer()->getTimeKeeper()->getTime(); };
  find<QSlider>("palpateFrame").setValue(1);
  expect_frame(1, "the slider");
  expect(pqtime() == 1, "ParaView's time is the same");
  save_screen("frame-2");
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

/// The row, the scene, what is shown and what is felt have the same filter; undo takes it away from all of them.
void a_filter_is_felt_and_shown() {
  scan_is_shown();
  click("palpateConnect");
  wait_ms(1500);
  const double raw_noise = shown_noise();
  const double raw_felt = number("palpateTissue");
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
  wait_ms(500);
  const double felt = number("palpateTissue");
  save_screen("filter-gaussian");
  expect(felt != raw_felt && std::abs(felt + 1000) < 4 * left * raw_noise, "the felt value is air's without noise");
  // Felt and not shown: it is said, and what is felt stays.
  click("palpateFilterShown");
  wait_for(
      "it is said", [] { return label("palpateFelt").contains("Gaussian filter of 1 mm (shown without it)"); }, 20);
  expect(shown_noise() == raw_noise, "the raw values are shown");
  expect(number("palpateTissue") == felt, "what is felt stays");
  click("palpateFilterShown");
  wait_for(
      "the filtered values are shown", [&] { return shown_noise() < raw_noise / 2; }, 20);
  turn_forces_on();
  find<QDoubleSpinBox>("palpateFilterAmount").setValue(2);
  wait_for(
      "another width is felt", [] { return label("palpateFelt").contains("Gaussian filter of 2 mm"); }, 20);
  expect(forces_are_on(), "another filter takes no force away");
  pqApplicationCore::instance()->getUndoStack()->undo();
  pqApplicationCore::instance()->getUndoStack()->undo();
  wait_for(
      "undo takes the filter away", [] { return !label("palpateFelt").contains("filter"); }, 20);
  expect(scene_text().find("\"filter\"") == std::string::npos, "the scene has no filter");
  expect(type.currentText() == "None", "the row says so");
  wait_for(
      "the raw values are shown", [&] { return shown_noise() == raw_noise; }, 20);
  wait_ms(500);
  // With its force on the stylus may have moved a little, and the noise with it.
  expect(std::abs(number("palpateTissue") - raw_felt) < raw_noise / 2, "the raw values are felt");
}

void a_flow_is_shown_and_felt() {
  choose_series(row_with("velocity of"));
  expect(scene_text().find("\"follow\"") != std::string::npos, "the scene is of flow");
  expect(find<QCheckBox>("palpateOn0").isChecked(), "its modes can be switched");
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
      5);
  expect(scene_text() == before, "the scene in the pipeline is the one that can be felt");
  expect(scenes.currentText() == named, "and the box says so");
  save_screen("scene-refused");
  // Also where somebody else puts it into the pipeline.
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source->getProxy()->GetXMLName() != std::string("PalpateScene")) continue;
    vtkSMPropertyHelper(source->getProxy(), "Scene").Set("flow");
    source->getProxy()->UpdateVTKObjects();
  }
  wait_ms(500);
  expect(scene_text() == before, "what is refused does not stay in the pipeline");
  connect_stylus();
  press();
}

}  // namespace

const Scenarios& shown_scenarios() {
  static const Scenarios all{
      {"no_scan_shown_no_force", no_scan_shown_no_force},
      {"a_reset_session_has_no_force", a_reset_session_has_no_force},
      {"a_loaded_state_has_no_force", a_loaded_state_has_no_force},
      {"undo_belongs_to_a_scan", undo_belongs_to_a_scan},
      {"a_filter_is_felt_and_shown", a_filter_is_felt_and_shown},
      {"frames_are_felt_as_shown", frames_are_felt_as_shown},
      {"a_flow_is_shown_and_felt", a_flow_is_shown_and_felt},
      {"a_scene_without_its_field_is_refused", a_scene_without_its_field_is_refused},
      {"the_hand_begins_in_sight", the_hand_begins_in_sight},
      {"keys_go_to_the_marked_view", keys_go_to_the_marked_view},
      {"slices_are_scrolled", slices_are_scrolled},
      {"slices_follow_the_pointer", slices_follow_the_pointer},
      {"slices_are_scrolled_upside_down", slices_are_scrolled},
  };
  return all;
}
