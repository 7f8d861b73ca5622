
#include <QCheckBox>
#include <QDialog>
#include <QDoubleSpinBox>
#include <QListWidget>
#include <QPushButton>
#include <QRegularExpression>
#include <QToolButton>

#include <stdexcept>

#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

void four_clicks() {
  feel();
  expect(clicks() <= 4, "it took at most four clicks");
  save_screen("four-clicks");
  const QRegularExpression depth("^[0-9.]+ mm past .*, known to .[0-9.]+ mm$");
  expect(comes_true([&] { return label("palpateDepth").contains(depth); }),
         "the depth is told, the boundary, and how well it is known: " + label("palpateDepth").toStdString());
  expect(label("palpateTissue").contains("HU"), "the value is told");
  expect(label("palpateSolver").contains("error below"), "the error is told");
}

void letting_go() {
  feel();
  let_go();
  wait_for("the simulated hand relaxes", [] { return number("palpateForce") < 0.05; });
}

void escape_releases() {
  feel();
  press_key(Qt::Key_Escape);
  wait_for(
      "the force is zero", [] { return number("palpateForce") == 0; }, 20);
  wait_for(
      "it says so", [] { return label("palpateState").startsWith("Ready"); }, 20);
  save_screen("released");
  click("palpateFeel");
  wait_for(
      "forces are on again", [] { return forces_are_on(); }, 20);
}

void escape_releases_under_a_dialog() {
  feel();
  in_dialog("palpateOpenScene", [](QDialog&) { press_key(Qt::Key_Escape); });
  wait_for(
      "the force is zero", [] { return number("palpateForce") == 0; }, 20);
}

void a_tissue_is_switched() {
  feel();
  const double felt = number("palpateForce");
  int switched = 0;
  for (int row = 0; row < 8; ++row) {
    const std::string name = "palpateOn" + std::to_string(row);
    if (!widget(name.c_str())) break;
    auto& box = find<QCheckBox>(name.c_str());
    if (box.isChecked()) {
      box.click();
      ++switched;
    }
  }
  expect(switched > 0, "there are tissues to switch");
  wait_for(
      "nothing is held any more", [&] { return number("palpateForce") < 0.3 * felt; }, 20);
  find<QCheckBox>("palpateOn0").click();
  wait_for(
      "the switch is in the scene", [] { return scene_text().find("\"enabled\": true") != std::string::npos; }, 20);
}

void a_curve_is_edited_and_undone() {
  scan_is_shown();
  connect_stylus();
  click("palpateCurvesSectionFold");
  const std::string before = scene_text();
  expect(!before.empty(), "the scene is in the pipeline");
  QWidget& chart = find<QWidget>("palpateStrengthCurveChart");
  scroll_to(find<QWidget>("palpateStrengthCurveValue"), chart);
  const QPoint middle = chart.rect().center();
  drag(chart, middle, middle, true);  // where there is no node a click makes one
  wait_for(
      "a node is chosen", [] { return find<QDoubleSpinBox>("palpateStrengthCurveValue").isEnabled(); }, 20);
  drag(chart, middle, middle - QPoint(0, 25), true);
  save_screen("curve");
  wait_for(
      "the edit is in the scene", [&] { return scene_text() != before; }, 20);
  const std::string edited = steady_scene();
  auto& value = find<QDoubleSpinBox>("palpateStrengthCurveValue");
  value.setValue(value.value() / 2);
  wait_for(
      "the number is in the scene", [&] { return scene_text() != edited; }, 20);
  click("palpateUndo");
  wait_for(
      "undone", [&] { return scene_text() == edited; }, 20);
  click("palpateRedo");
  wait_for(
      "done again", [&] { return scene_text() != edited; }, 20);
  for (int n = 0; n < 40 && scene_text() != before; ++n) click("palpateUndo");  // a drag that rested is several edits
  expect(scene_text() == before, "undo leads back to the scene as it was");
}

void a_fault_is_cleared() {
  feel();
  hang();  // nobody could release
  wait_for(
      "the fault is told",
      [] {
        return label("palpateState").startsWith("Stopped: The panel stopped answering") &&
               find<QPushButton>("palpateFeel").text() == "Clear fault";
      },
      20);
  save_screen("fault");
  wait_for(
      "the force was taken away", [] { return number("palpateForce") == 0; }, 20);
  click("palpateFeel");  // "Clear fault"
  wait_for(
      "it is ready, and no more", [] { return label("palpateState").startsWith("Ready: no force"); }, 20);
  wait_ms(1000);
  expect(label("palpateState").startsWith("Ready: no force") && number("palpateForce") == 0,
         "clearing a fault turns no force on");
  click("palpateFeel");
  wait_for(
      "forces are on again", [] { return forces_are_on(); }, 20);
}

void the_view_is_clutched() {
  feel();
  wait_for(
      "the mapping stays while something is held", [] { return !find<QToolButton>("palpateFitView").isEnabled(); }, 20);
  click("palpateClutch");
  wait_for(
      "no force", [] { return number("palpateForce") == 0; }, 20);
  wait_for(
      "clutched, the mapping may change", [] { return find<QToolButton>("palpateFitView").isEnabled(); }, 20);
  find<QCheckBox>("palpateTurn").setChecked(true);
  const std::string before = scene_text();
  click("palpateClutch");
  wait_for(
      "forces are on again", [] { return forces_are_on(); }, 20);
  expect(scene_text() != before, "the mapping is turned as the view is");
}

void the_scan_changes_in_mid_contact() {
  auto& series = find<QListWidget>("palpateSeries");
  wait_for("the series are listed", [&] { return series.count() > 1; });
  click(*series.viewport(), series.visualItemRect(series.item(0)).center());
  feel();
  click("palpateScanSectionFold");
  is_laid_out(*series.viewport());
  const unsigned before = reader_in_pipeline();
  const QRect other = series.visualItemRect(series.item(1));
  click(*series.viewport(), other.center());
  another_scan_is_shown(before);
  wait_ms(1500);
  expect(number("palpateForce") < 3.1, "the force keeps its limit");
  expect(find<QPushButton>("palpateConnect").text() == "Disconnect", "the stylus is still held");
}

void a_series_is_picked() {
  wait_for("the series are listed", [] { return find<QListWidget>("palpateSeries").count() > 1; });
  expect(label("palpateMessage").endsWith(" series: choose one."), "it is said that one is to be chosen");
  wait_ms(1000);
  save_screen("mixed");
  auto& series = find<QListWidget>("palpateSeries");
  for (int n = 0; n < series.count(); ++n) {
    if (!series.item(n)->text().startsWith("MR")) continue;
    series.scrollToItem(series.item(n));
    click(*series.viewport(), series.visualItemRect(series.item(n)).center());
    scan_is_shown();
    save_screen("mr");
    return;
  }
  throw std::runtime_error("no MR series is listed");
}

void a_bad_folder() {
  wait_for("it is said what is wrong", [] {
    return label("palpateMessage") ==
           "No image series in this folder (1 file(s) looked at): choose the one that holds the DICOM files.";
  });
  save_screen("bad-folder");
  expect(!find<QPushButton>("palpateConnect").isEnabled(), "there is nothing to connect to");
}

/// A scan that is tilted and has uneven slices: what there is to know of it, and what goes wrong around it, in words.
void what_is_to_be_known_is_said() {
  click("palpateRecordingsSectionFold");
  name_file("palpateOpenRecording", "/proc/version");  // any file: without a scan none is read
  wait_for("recordings wait for their scan", [] {
    return label("palpateRecordingMessage") ==
           "A recording is shown in its scan: open the scan that was felt, then the recording.";
  });
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  scan_is_shown();
  const auto is_said = [](const char* sentence) { return label("palpateMessage").split('\n').contains(sentence); };
  const char* const resampled = "Display resampled, touch is not.";
  const char* const of_filters = "Oblique or tilted: use Palpate's Tissue Surface, not ParaView's Contour.";
  expect(is_said(resampled), "it is said how it is drawn");
  expect(!is_said(of_filters), "what is to be known of ParaView's filters is not told while they are hidden");
  find<QToolButton>("palpateAdvancedButton").click();
  const unsigned before = reader_in_pipeline();
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  another_scan_is_shown(before);
  expect(is_said(resampled) && is_said(of_filters), "under Advanced both are");
  const QString nowhere = "/proc/scene.json";  // not even root may make one there
  name_file("palpateSaveScene", nowhere);
  const QRegularExpression refusal("^/proc/scene\\.json cannot be written: .+$");
  wait_for("a scene that cannot be saved is told of",
           [&] { return refusal.match(label("palpateSceneMessage")).hasMatch(); });
  save_screen("said");
}

/// The program ends with the button down and the stylus pressed: by itself, with exit code 0.
void closed_in_mid_contact() {
  feel();
}

const Scenarios scenarios{
    {"four_clicks", four_clicks},
    {"letting_go", letting_go},
    {"escape_releases", escape_releases},
    {"escape_releases_under_a_dialog", escape_releases_under_a_dialog},
    {"a_tissue_is_switched", a_tissue_is_switched},
    {"a_curve_is_edited_and_undone", a_curve_is_edited_and_undone},
    {"a_fault_is_cleared", a_fault_is_cleared},
    {"the_view_is_clutched", the_view_is_clutched},
    {"the_scan_changes_in_mid_contact", the_scan_changes_in_mid_contact},
    {"a_series_is_picked", a_series_is_picked},
    {"a_bad_folder", a_bad_folder},
    {"what_is_to_be_known_is_said", what_is_to_be_known_is_said},
    {"closed_in_mid_contact", closed_in_mid_contact},
};

/// What is tested is the panel, however busy the machine is. Measurements have the computer's clock.
void choose_clock(const std::string& name) {
  if (!widget("PalpatePanel") || name == "main_thread" || name == "first_image" || name.starts_with("rounds_of_") ||
      name == "memory_of_a_scan" || name == "nothing_moves")
    return;
  const bool left_alone = name == "a_short_press_counts";
  panel_session().set_clock([left_alone](double period_s) { return panel_clock(period_s, left_alone); });
}

}  // namespace

void run_scenario(const std::string& name) {
  choose_clock(name);
  wait_ms(1000);
  for (const Scenarios* const some : {&scenarios,
                                      &archive_scenarios(),
                                      &choosing_scenarios(),
                                      &contour_scenarios(),
                                      &correct_scenarios(),
                                      &correct_state_scenarios(),
                                      &device_scenarios(),
                                      &felt_trace_scenarios(),
                                      &frame_scenarios(),
                                      &hand_scenarios(),
                                      &heap_scenarios(),
                                      &interchange_scenarios(),
                                      &language_scenarios(),
                                      &layout_scenarios(),
                                      &look_scenarios(),
                                      &overtaken_scenarios(),
                                      &legible_scenarios(),
                                      &mark_scenarios(),
                                      &measured_scenarios(),
                                      &sent_mark_scenarios(),
                                      &picture_scenarios(),
                                      &profile_scenarios(),
                                      &recording_scenarios(),
                                      &remote_scenarios(),
                                      &sharing_scenarios(),
                                      &shown_scenarios(),
                                      &slice_scenarios(),
                                      &story_scenarios(),
                                      &structure_scenarios(),
                                      &reading_scenarios(),
                                      &tuning_scenarios(),
                                      &unsaved_scenarios(),
                                      &volume_drawing_scenarios(),
                                      &volume_scenarios()}) {
    if (const auto found = some->find(name); found != some->end()) return found->second();
  }
  throw std::runtime_error("there is no scenario " + name);
}
