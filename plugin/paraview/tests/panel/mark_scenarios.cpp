// Marks: made where the stylus touches, measured, changed, undone, and kept. The panel's values are compared with the
// recording of the same session, and with arithmetic on its positions.

#include <pqApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMTrace.h>

#include <QAction>
#include <QCoreApplication>
#include <QFile>
#include <QImage>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "plugin/app/scan_choice.h"
#include "plugin/paraview/common/scan_store.h"
#include "plugin/paraview/tests/panel/mark_steps.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"
#include "plugin/recording/recorded_session.h"
#include "plugin/report/kept_marks.h"

namespace {

using namespace palpate;

/// Also where the window is too narrow for it.
bool toolbar_tells() {
  return find<QWidget>("palpateToolbar").findChild<QAction*>("palpateToolbarMarks")->isVisible();
}

std::shared_ptr<const io::Volume> scan() {
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source->getProxy()->GetXMLName() != std::string("PalpateDicomReader")) continue;
    const std::string path = vtkSMPropertyHelper(source->getProxy(), "FileName").GetAsString();
    const std::string uid = vtkSMPropertyHelper(source->getProxy(), "SeriesUid").GetAsString();
    const auto catalogue = plugin::find_scans(path);
    return plugin::load_scan(catalogue->series[plugin::choose_scan(*catalogue, uid, path)], 0);
  }
  throw std::runtime_error("there is no scan");
}

void record_to(const QString& file) {
  QFile::remove(file);
  name_file("palpateRecord", file);
  wait_for(
      "it is recorded", [] { return find<QPushButton>("palpateRecord").text() == "Stop recording"; }, 20);
  turn_forces_on();
  stylus_rests();
}

plugin::RecordedSession recorded(const QString& file) {
  click("palpateRecord");
  wait_for("the recording is closed", [] { return find<QPushButton>("palpateRecord").text() != "Stop recording"; });
  return {plugin::read_recording(file.toStdString()), *scan()};
}

/// The ticks at which the mark button went down.
std::vector<std::size_t> presses_in(const plugin::RecordedSession& session) {
  std::vector<std::size_t> pressed;
  for (std::size_t n = 1; n < session.size(); ++n) {
    if ((session.tick(n).buttons & 2U) != 0 && (session.tick(n - 1).buttons & 2U) == 0) pressed.push_back(n);
  }
  return pressed;
}

/// How many pixels of a view have nearly the color of marks.
int pixels_of_marks(const char* name) {
  const QImage picture = view(name).grab().toImage();
  int count = 0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const QColor at = picture.pixelColor(x, y);
      count += at.red() > 180 && at.green() < 0.6 * at.red() && at.blue() > 0.6 * at.red() ? 1 : 0;
    }
  }
  return count;
}

/// As the panel writes it, with two decimals.
std::string millimeters(double mm) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f mm", mm);
  return text;
}

void expect_near(double found, double wanted, double within, const std::string& what) {
  expect(std::abs(found - wanted) <= within,
         what + ": " + std::to_string(found) + " instead of " + std::to_string(wanted));
}

/// A mark is where the proxy was, and says what was felt there.
void marks_are_where_the_stylus_was() {
  scan_is_shown();
  expect(!find<QPushButton>("palpateMark").isEnabled(), "without a stylus there is nothing to mark");
  expect(!toolbar_tells(), "and no marks to be gone to");
  connect_stylus();
  record_to(beside_pictures("marks.h5"));
  mark_three();
  hold_key_in(view("Coronal"), "m", true);
  step("Left", 10);
  hold_key_in(view("Coronal"), "m", false);
  has_rows(4, "kept down it is a path");
  expect(toolbar_tells(), "the toolbar tells of marks");
  wait_for(
      "they are seen in the volume view", [] { return pixels_of_marks("Volume") > 30; }, 20);
  const QStringList drawn = measured_in("Volume");
  for (const char* const name : {"Mark 1", "Mark 2", "Mark 3", "Path 1"}) {
    expect(drawn.contains(name), std::string(name) + " is named in the volume view");
  }
  scroll_to(find<QWidget>("palpateSendMarks"));
  choose_marks({0, 1});
  views_rest();
  save_screen("marks");

  const plugin::RecordedSession session = recorded(beside_pictures("marks.h5"));
  const std::vector<std::size_t> pressed = presses_in(session);
  const plugin::Marks marks = kept_marks();
  expect(marks.points.size() == 3 && marks.paths.size() == 1 && pressed.size() == 4, "three marks and a path");
  for (std::size_t n = 0; n < 3; ++n) {
    const plugin::FeltMark& mark = marks.points[n];
    expect(glm::distance(mark.position_mm, session.proxy_mm(pressed[n])) < 1e-9, mark.name + " is where the proxy was");
    expect_near(mark.force_n, glm::length(session.sent_n(pressed[n])), 1e-9, "its force");
    expect(mark.value == session.tick(pressed[n]).value, "its value");
    expect(mark.force_n > 0.1 && !mark.boundary.empty(), "something was felt there");
    // The ball's surface: 25 mm around the middle.
    expect_near(glm::length(mark.position_mm), 25, 2.5, "it is on the surface that is felt");
    const QString row = mark_list().topLevelItem(static_cast<int>(n))->text(1);
    expect(row.startsWith(QString::fromStdString(mark.boundary)), "the row names the boundary: " + row.toStdString());
  }
  const plugin::MarkedPath& path = marks.paths[0];
  double way_mm = 0;
  std::size_t end = pressed[3];
  for (; end + 1 < session.size() && (session.tick(end + 1).buttons & 2U) != 0; ++end) {
    way_mm += glm::distance(session.proxy_mm(end), session.proxy_mm(end + 1));
  }
  const double chord_mm = glm::distance(session.proxy_mm(pressed[3]), session.proxy_mm(end));
  expect(chord_mm > 5, "the hand went some way");
  expect(path.length_mm >= chord_mm - 1e-9 && path.length_mm <= way_mm + 1e-9,
         "the path is as long as the way along the surface");
  expect(glm::distance(path.points_mm.back(), session.proxy_mm(end)) < 1e-9, "it ends where the button was let go");

  const plugin::Marks again = plugin::marks_of(session);
  expect(again.points.size() == 3 && again.paths.size() == 1, "the recording holds them, too");
  for (std::size_t n = 0; n < 3; ++n) {
    expect(again.points[n].name == marks.points[n].name && again.points[n].boundary == marks.points[n].boundary &&
               glm::distance(again.points[n].position_mm, marks.points[n].position_mm) < 1e-9,
           "as the panel has them");
  }
}

/// With four marks: a path is chosen, and then its name typed, while a mark takes the row above it.
void a_chosen_path_stays_chosen() {
  const auto path_is_made = [](int rows, const char* key) {
    hold_key_in(view("Coronal"), "m", true);
    step(key, 10);
    hold_key_in(view("Coronal"), "m", false);
    has_rows(rows, "a path is made");
  };
  path_is_made(5, "Left");
  choose_marks({4});
  mark_by_key();
  expect(mark_list().topLevelItem(5)->isSelected() && !mark_list().topLevelItem(4)->isSelected(),
         "the path is still what is chosen");
  click("palpateDeleteMark");
  wait_for(
      "the path is deleted", [] { return kept_marks().paths.empty(); }, 20);
  expect(kept_marks().points.size() == 5, "and no mark");
  path_is_made(6, "Right");
  mark_list().editItem(mark_list().topLevelItem(5), 0);
  auto* const editor = mark_list().findChild<QLineEdit*>();
  expect(editor != nullptr, "a name can be typed");
  editor->setText("along the rib");
  find<QPushButton>("palpateMark").click();  // as the stylus' own button: the focus stays
  has_rows(7, "the button marks");
  expect(editor->text() == "along the rib", "what was typed stays, and not: " + editor->text().toStdString());
  QKeyEvent enter(QEvent::KeyPress, Qt::Key_Return, Qt::NoModifier);
  QCoreApplication::sendEvent(editor, &enter);
  wait_for(
      "the path has the name", [] { return kept_marks().paths[0].name == "along the rib"; }, 20);
  expect(kept_marks().points[5].name == "Mark 6", "and not the mark");
}

/// Distance and angle by the places alone; each step taken back and done again.
void marks_are_measured_and_changed() {
  scan_is_shown();
  connect_stylus();
  mark_three();
  const std::string three = marks_text();
  const plugin::Marks marks = kept_marks();
  const auto between = [&](std::size_t a, std::size_t b) {
    return glm::distance(marks.points[a].position_mm, marks.points[b].position_mm);
  };
  choose_marks({0, 1});
  expect(label("palpateMeasured").toStdString() == millimeters(between(0, 1)) + " from Mark 1 to Mark 2",
         "two marks give a distance: " + label("palpateMeasured").toStdString());
  click("palpateKeepMeasure");
  has_rows(4, "it is kept");
  expect(mark_list().topLevelItem(3)->text(1).toStdString() == millimeters(between(0, 1)), "and listed");
  expect(measured_in("Volume").contains(QString::number(between(0, 1), 'f', 1) + " mm"), "and drawn");
  mark_list().topLevelItem(2)->setSelected(true);
  const double a = between(0, 1), b = between(1, 2), c = between(0, 2);
  const double degrees = std::acos((a * a + b * b - c * c) / (2 * a * b)) * 180 / std::acos(-1.0);
  expect(label("palpateMeasured") == QString("%1° at Mark 2").arg(degrees, 0, 'f', 1),
         "three give the angle at the second: " + label("palpateMeasured").toStdString());
  click("palpateKeepMeasure");
  has_rows(5, "it is kept, too");
  save_screen("marks-measured");
  click("palpateUndoMark");
  has_rows(4, "the angle is taken back");
  click("palpateUndoMark");
  has_rows(3, "and the distance");
  expect(marks_text() == three, "and nothing else");

  mark_list().topLevelItem(1)->setText(0, "edge of the liver");
  wait_for(
      "it is renamed", [] { return kept_marks().points[1].name == "edge of the liver"; }, 20);
  expect(measured_in("Volume").contains("edge of the liver"), "in the views, too");
  choose_marks({1});
  click("palpateDeleteMark");
  has_rows(2, "it is deleted");
  expect(!measured_in("Volume").contains("edge of the liver"), "in the views, too");
  click("palpateUndoMark");
  has_rows(3, "it is back");
  expect(kept_marks().points[1].name == "edge of the liver", "as it was");
  click("palpateUndoMark");
  wait_for(
      "with its first name", [&] { return marks_text() == three; }, 20);

  go_to("Right", 8);
  choose_marks({2});
  click("palpateMoveMark");
  wait_for(
      "it is moved", [&] { return marks_text() != three; }, 20);
  const glm::dvec3 moved = kept_marks().points[2].position_mm;
  expect(kept_marks().points[2].name == "Mark 3", "it keeps its name");
  expect(glm::distance(moved, marks.points[2].position_mm) > 4, "to where the hand went");
  mark_by_key();  // the hand has not moved since
  expect(glm::distance(moved, kept_marks().points[3].position_mm) < 0.5, "where a mark would be now");
  a_chosen_path_stays_chosen();
  for (int n = 0; n < 15 && !marks_text().empty(); ++n) click("palpateUndoMark");
  has_rows(0, "all is taken back");
  expect(!toolbar_tells(), "the toolbar tells of none");
}

/// Another scan has its own; they are there again when the first comes back.
void marks_belong_to_a_scan() {
  auto& series = find<QListWidget>("palpateSeries");
  wait_for("the series are listed", [&] { return series.count() > 1; });
  const auto open = [&](int row) {
    if (!series.isVisible()) click("palpateScanSectionFold");
    is_laid_out(*series.viewport());
    const unsigned before = reader_in_pipeline();
    click(*series.viewport(), series.visualItemRect(series.item(row)).center());
    another_scan_is_shown(before);
  };
  open(0);
  connect_stylus();
  press_key_in(view("Coronal"), "m");
  has_rows(1, "a mark on the first");
  const std::string text = marks_text();
  open(1);
  has_rows(0, "the other has none");
  expect(marks_text() == text, "they wait");
  press_key_in(view("Coronal"), "m");
  has_rows(1, "it gets its own");
  expect(plugin::marks_of_text(marks_text()).size() == 2, "of two scans");
  open(0);
  has_rows(1, "the first has its own again");
  expect(plugin::marks_of_text(text).begin()->second.points[0].position_mm ==
             plugin::marks_of_text(marks_text()).at(plugin::marks_of_text(text).begin()->first).points[0].position_mm,
         "where it was");
}

/// In a state file and in a trace.
void marks_are_saved() {
  scan_is_shown();
  connect_stylus();
  vtkSMTrace* const trace = vtkSMTrace::StartTrace();
  trace->SetPropertiesToTraceOnCreate(vtkSMTrace::RECORD_MODIFIED_PROPERTIES);
  mark_three();
  choose_marks({0, 2});
  click("palpateKeepMeasure");
  has_rows(4, "a distance is kept");
  const std::string traced = vtkSMTrace::StopTrace();
  expect(traced.find(".Marks = ") != std::string::npos && traced.find("Mark 3") != std::string::npos,
         "a trace holds the marks");
  QFile file(beside_pictures("marks.json"));
  expect(file.open(QIODevice::WriteOnly), "what is to be restored can be written");
  file.write(marks_text().c_str());
  click("palpateConnect");
  expect(pqApplicationCore::instance()->saveState(beside_pictures("marks.pvsm")), "the state is saved");
}

/// In a program of its own, started with that state.
void marks_are_restored() {
  scan_is_shown();
  has_rows(4, "they are listed");
  QFile file(beside_pictures("marks.json"));
  expect(file.open(QIODevice::ReadOnly), "there is what was saved");
  expect(file.readAll().toStdString() == marks_text(), "to the last digit");
  expect(measured_in("Volume").contains("Mark 3"), "and drawn");
  if (!mark_list().isVisible()) click("palpateMarksSectionFold");
  connect_stylus();
  mark_by_key();
  expect(kept_marks().points.back().name == "Mark 4", "and one can go on");
  views_rest();
  save_screen("marks-restored");
}

/// In a program that has another scan open, and a mark on it.
void marks_are_loaded() {
  scan_is_shown();
  connect_stylus();
  press_key_in(view("Coronal"), "m");
  has_rows(1, "the other scan has a mark");
  click("palpateConnect");
  load_state(beside_pictures("marks.pvsm"));
  expect_four_views_of_one_scan();
  expect(plugin::marks_of_text(marks_text()).size() == 1, "the marks are the state's alone");
  marks_are_restored();
}

}  // namespace

const Scenarios& mark_scenarios() {
  static const Scenarios scenarios{
      {"marks_are_where_the_stylus_was", marks_are_where_the_stylus_was},
      {"marks_are_measured_and_changed", marks_are_measured_and_changed},
      {"marks_belong_to_a_scan", marks_belong_to_a_scan},
      {"marks_are_saved", marks_are_saved},
      {"marks_are_restored", marks_are_restored},
      {"marks_are_loaded", marks_are_loaded},
  };
  return scenarios;
}
