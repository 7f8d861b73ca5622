#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqRenderView.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QCursor>
#include <QDialog>
#include <QDoubleSpinBox>
#include <QElapsedTimer>
#include <QEventLoop>
#include <QGuiApplication>
#include <QImage>
#include <QLineEdit>
#include <QListWidget>
#include <QPixmap>
#include <QPushButton>
#include <QRegularExpression>
#include <QScreen>
#include <QTimer>
#include <QToolButton>

#include <sys/resource.h>

#include <cstdio>
#include <map>
#include <stdexcept>

#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/views/caster.h"
#include "plugin/paraview/client/views/event_watch.h"
#include "plugin/paraview/tests/panel/busy_watch.h"
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

/// Not a test but a measurement: how long the main thread is busy at a stretch while one probes. ParaView updates its
/// slices before it renders them: that is only left out where they do not follow.
void main_thread() {
  feel();
  QWidget& sagittal = view("Sagittal");
  const QPoint from = proxy_in(sagittal);
  // Not by a program of its own, whose start would keep this thread busy for longer than the panel does.
  const auto point_at = [&](int x, int y) { QCursor::setPos(sagittal.mapToGlobal(from + QPoint(x, y))); };
  const auto print_events = [](const BusyWatch& watch) {
    const std::vector<double> events = watch.events_ms();
    std::printf(
        "main_thread: from an event to the next, of a processor, at most %.1f ms, one in a hundred %.1f ms or more\n",
        events.at(0), events.at(events.size() / 100));
  };
  for (const bool follow : {true, false}) {
    find<QCheckBox>("palpateFollow").setChecked(follow);
    const BusyWatch watch;
    for (int n = 0; n < 240; ++n) {
      point_at(10, std::abs(n % 120 - 60) - 30);
      wait_ms(30);
    }
    const std::vector<double> stretches = watch.without_rendering();
    std::printf(
        "main_thread: probing, slices %s: %zu stretches of events; without rendering the longest took %.1f ms, one in "
        "a hundred %.1f ms or more; with ParaView's rendering the longest took %.1f ms\n",
        follow ? "follow" : "stay", stretches.size(), stretches.at(0), stretches.at(stretches.size() / 100),
        watch.longest_with_rendering_ms());
    print_events(watch);
  }
  const BusyWatch watch;
  QElapsedTimer clock;
  double full_s = 0, longest_s = 0;
  bool had_rows_left = false;
  // A hand that creeps on a little later has its next picture: the first counts.
  const palpate::plugin::EventWatch drawn(
      render_view("Volume").getRenderViewProxy()->GetRenderer(), vtkCommand::EndEvent, [&] {
        const bool has_rows_left = caster_of_the_volume().has_rows_left();
        if (std::exchange(had_rows_left, has_rows_left) && !has_rows_left && full_s == 0) {
          full_s = 1e-3 * static_cast<double>(clock.elapsed());
        }
      });
  constexpr int rests = 6, rest_ms = 2500;
  for (int n = 0; n < rests; ++n) {
    point_at(10, n % 2 == 0 ? 20 : -20);
    clock.start();
    full_s = 0;
    wait_ms(rest_ms);
    longest_s = std::max(longest_s, full_s > 0 ? full_s : 1e-3 * rest_ms);
  }
  std::printf("main_thread: coming to rest, the volume in full at most %.2f s after the pointer's last move:\n",
              longest_s);
  print_events(watch);
}

/// Whether something gray stands in the middle of a view on the screen. The light start page stands there before.
bool is_painted(const char* name) {
  if (!find<QPushButton>("palpateConnect").isEnabled()) return false;
  if (render_view(name).getRenderViewProxy()->GetRenderWindow()->GetNeverRendered() != 0) return false;
  // Something in the middle half: a volume may be clear in its middle, as lungs are.
  const QWidget& on = view(name);
  const QSize half = on.size() / 2;
  const QPoint corner = on.mapToGlobal(on.rect().center()) - QPoint(half.width() / 2, half.height() / 2);
  const QImage seen = QGuiApplication::primaryScreen()
                          ->grabWindow(0, corner.x(), corner.y(), half.width(), half.height())
                          .toImage()
                          .scaled(8, 8, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
  for (int n = 0; n < 64; ++n) {
    if (qGray(seen.pixel(n % 8, n / 8)) > 16) return true;
  }
  return false;
}

/// Those of 100 ms or more, each with when it began.
void print_stretches(const BusyWatch& watch) {
  constexpr double long_ms = 100;
  for (const BusyWatch::Stretch& one : watch.stretches()) {
    if (one.took_ms < long_ms) continue;
    std::printf("first_image: busy from %.2f s on for %.0f ms (%.0f of a processor), %.0f of them rendering\n",
                1e-3 * one.began_ms, one.took_ms, one.processor_ms, one.rendering_ms);
  }
}

/// Not a test but a measurement: how long after a folder is dropped its scan is on the screen, and its tissues in the
/// panel; and how long the main thread is busy at a stretch until the views rest.
void first_image() {
  QElapsedTimer clock;
  clock.start();
  const BusyWatch watch;
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  wait_for("the scan is on the screen", [] { return is_painted("Axial"); });
  const double image_s = 1e-3 * static_cast<double>(clock.elapsed());
  wait_for("its tissues are found",
           [] { return !find<QWidget>("palpateStudying").isVisible() && widget("palpateOn0") != nullptr; });
  const double tissues_s = 1e-3 * static_cast<double>(clock.elapsed());
  wait_for("the volume is on the screen", [] { return is_painted("Volume"); });
  const double volume_s = 1e-3 * static_cast<double>(clock.elapsed());
  views_rest();
  save_screen("first-image");
  std::printf(
      "first_image: on the screen after %.2f s, tissues in the panel after %.2f s, and the volume by %.2f s; the main "
      "thread was busy for at most %.0f ms without rendering and %.0f ms with it\n",
      image_s, tissues_s, volume_s, watch.without_rendering().at(0), watch.longest_with_rendering_ms());
  print_stretches(watch);
}

double processor_s() {
  rusage used;
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& of) {
    return static_cast<double>(of.tv_sec) + 1e-6 * static_cast<double>(of.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Counts what is painted, by name: whatever is painted anew costs a picture of the whole window.
class Painted : public QObject {
 public:
  Painted() { qApp->installEventFilter(this); }
  ~Painted() override {
    for (const auto& [name, count] : counts_) {
      if (count > 1) std::printf("nothing_moves: painted %d times: %s\n", count, name.toUtf8().constData());
    }
  }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override {
    if (event->type() == QEvent::Paint) {
      ++counts_[watched->objectName() + QLatin1Char(' ') + QLatin1String(watched->metaObject()->className())];
    }
    return false;
  }

 private:
  std::map<QString, int> counts_;
};

/// Part of a core that the whole program takes, in percent, over some seconds in which nobody does anything.
double processor_at_rest() {
  constexpr int ms = 10'000;
  const double before = processor_s();
  const Painted painted;
  QEventLoop rest;  // polls nothing
  QTimer::singleShot(ms, &rest, &QEventLoop::quit);
  rest.exec();
  return 100 * (processor_s() - before) / (1e-3 * ms);
}

/// A measurement that is a test, too, with room for a busy machine: a scan is open and nothing moves.
void nothing_moves() {
  scan_is_shown();
  wait_for("its tissues are found", [] { return !find<QWidget>("palpateStudying").isVisible(); });
  for (int n = 0; n < 3; ++n) views_rest();
  const double open = processor_at_rest();
  click("palpateConnect");
  for (int n = 0; n < 3; ++n) views_rest();
  const double connected = processor_at_rest();
  click("palpateFeel");
  for (int n = 0; n < 3; ++n) views_rest();
  const double felt = processor_at_rest();
  std::printf(
      "nothing_moves: %.1f %% of a core with a scan open, %.1f %% with a stylus connected, %.1f %% with its force on\n",
      open, connected, felt);
  expect(open < 5 && connected < 10, "nothing is done over and over");
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
    {"main_thread", main_thread},
    {"first_image", first_image},
    {"nothing_moves", nothing_moves},
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
                                      &legible_scenarios(),
                                      &mark_scenarios(),
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
                                      &volume_scenarios()}) {
    if (const auto found = some->find(name); found != some->end()) return found->second();
  }
  throw std::runtime_error("there is no scenario " + name);
}
