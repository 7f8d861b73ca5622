#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFile>
#include <QImage>
#include <QPushButton>
#include <QSlider>
#include <QToolButton>

#include <algorithm>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// A press, recorded.
void record_a_press(const QString& file) {
  QFile::remove(file);
  name_file("palpateRecord", file);
  wait_for(
      "it is being recorded", [] { return find<QPushButton>("palpateRecord").text() == "Stop recording"; }, 20);
  expect(label("palpateStylusMessage") ==
             "Recording: the session was started again, so that it can be repeated to the last bit.",
         "it is said that the session was started again");
  wait_for(
      "forces are on", [] { return forces_are_on(); }, 20);
  stylus_rests();
  press();
  let_go();
  wait_for(
      "the simulated hand relaxes", [] { return number("palpateForce") < 0.05; }, 20);
  click("palpateRecord");
  wait_for(
      "the recording is written and open",
      [&] { return QFile::exists(file) && file.endsWith("/" + label("palpateRecordingName")); }, 20);
}

void recordings_are_replayed_and_compared() {
  const QString folder = qEnvironmentVariable("PALPATE_PICTURES");
  scan_is_shown();
  connect_stylus();
  record_a_press(folder + "/first.h5");
  expect(!find<QToolButton>("palpatePlay").isEnabled(), "the views show what is felt, not what was");
  expect(find<QWidget>("palpatePlayWhyNot").isVisible(), "and that is said where it would be played");
  auto& strength = find<QDoubleSpinBox>("palpateStrength0");
  strength.setValue(strength.value() / 2);
  record_a_press(folder + "/second.h5");
  click("palpateConnect");
  wait_for(
      "the stylus is let go", [] { return label("palpateState").startsWith("Off"); }, 20);

  auto& slider = find<QSlider>("palpateScrub");
  double most = 0;
  int most_ms = 0;
  for (int n = 0; n <= 40; ++n) {
    slider.setValue(slider.maximum() * n / 40);
    handle_events(10);  // until it is looked at
    if (number("palpateForce") > most) {
      most = number("palpateForce");
      most_ms = slider.value();
    }
  }
  expect(most > 0.1, "the recorded force is seen while one scrubs");
  slider.setValue(most_ms);
  proxy_in(view("Sagittal"));  // throws where it is not seen
  expect(label("palpateTick").startsWith("recorded"), "it is said that this is a recording");
  scroll_to(find<QWidget>("palpateCloseRecording"));
  wait_ms(300);
  save_screen("replay");

  slider.setValue(0);
  find<QComboBox>("palpateReplaySpeed").setCurrentIndex(5);  // fastest
  emit find<QComboBox>("palpateReplaySpeed").activated(5);
  const auto sign_of_play = [] { return find<QToolButton>("palpatePlay").icon().pixmap(16, 16).toImage(); };
  const QImage play = sign_of_play();
  click("palpatePlay");
  const QImage pause = sign_of_play();
  const auto is_empty = [](const QImage& sign) { return sign == QImage(sign.size(), sign.format()) || sign.isNull(); };
  expect(!is_empty(play) && !is_empty(pause) && play != pause, "a sign for play, and another for pause");
  wait_for(
      "it plays to its end by itself", [&] { return slider.value() == slider.maximum(); }, 60);

  name_file("palpateCompare", folder + "/first.h5");
  wait_for(
      "the two are compared", [] { return label("palpateRecordingMessage").contains("Forces differ by at most"); }, 20);
  scroll_to(find<QWidget>("palpateRecordingMessage"));
  wait_ms(1000);
  save_screen("comparison");
  save_as("palpateComparisonTable", folder + "/comparison.csv");
  save_as("palpateComparisonPicture", folder + "/comparison.png");

  name_file("palpateCompare", folder + "/comparison.csv");
  wait_for(
      "what is no recording is refused in words",
      [] { return label("palpateRecordingMessage").contains("recording comparison.csv"); }, 20);
  // What is felt is not taken for a recording, whatever was looked at before.
  slider.setValue(most_ms);
  connect_stylus();
  expect(label("palpateTick").contains("missed"), "the footer tells of the stylus again");
  click("palpateConnect");
  click("palpateCloseRecording");
  expect(!find<QSlider>("palpateScrub").isVisible(), "the recordings are closed");
  wait_for(
      "nothing is shown any more", [] { return label("palpateDepth") == "no stylus"; }, 20);
}

/// A recording of the first of two frames is not seen over the second.
void a_recording_is_of_its_frame() {
  const QString file = qEnvironmentVariable("PALPATE_PICTURES") + "/first-frame.h5";
  QFile::remove(file);
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  scan_is_shown();
  connect_stylus();
  name_file("palpateRecord", file);
  wait_for(
      "it is being recorded", [] { return find<QPushButton>("palpateRecord").text() == "Stop recording"; }, 20);
  stylus_rests();
  click("palpateRecord");
  auto& slider = find<QSlider>("palpateScrub");
  wait_for(
      "the recording is open", [&] { return label("palpateRecordingName") == "first-frame.h5" && slider.isVisible(); },
      20);
  expect(label("palpateRecordingMessage").isEmpty(),
         "nothing is left out: " + label("palpateRecordingMessage").toStdString());
  find<QSlider>("palpateFrame").setValue(1);
  wait_for(
      "the second frame is felt", [] { return label("palpateFelt").contains("2 of 2."); }, 20);
  expect(!slider.isVisible() && label("palpateRecordingName").isEmpty(), "the recording is closed");
  expect(label("palpateRecordingMessage") ==
             "first-frame.h5 was closed: another frame is shown. Open it again to see what was recorded on this frame.",
         "and that is said: " + label("palpateRecordingMessage").toStdString());
  save_screen("recording-closed");
}

}  // namespace

const Scenarios& recording_scenarios() {
  static const Scenarios all{{"recordings_are_replayed_and_compared", recordings_are_replayed_and_compared},
                             {"a_recording_is_of_its_frame", a_recording_is_of_its_frame}};
  return all;
}
