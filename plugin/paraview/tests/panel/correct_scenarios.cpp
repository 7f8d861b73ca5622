#include <pqCoreUtilities.h>

#include <QAction>
#include <QComboBox>
#include <QDialog>
#include <QEvent>
#include <QFile>
#include <QGuiApplication>
#include <QLabel>
#include <QPixmap>
#include <QProgressBar>
#include <QPushButton>
#include <QScreen>
#include <QSlider>
#include <QTreeWidget>

#include <array>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <string>
#include <variant>

#include "io/structures/structure.h"
#include "plugin/paraview/tests/panel/correct_steps.h"
#include "plugin/paraview/tests/panel/drawn_lines.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// What is on the screen there, where guide_pictures.py asks for it.
void save_for_guide(const char* name, QWidget& shown) {
  const QString folder = qEnvironmentVariable("PALPATE_GUIDE");
  if (folder.isEmpty()) return;
  scroll_to(shown);
  wait_ms(1000);
  const QRect at(shown.mapToGlobal(QPoint(0, 0)), shown.size());
  const QPixmap picture = QGuiApplication::primaryScreen()->grabWindow(0, at.x(), at.y(), at.width(), at.height());
  expect(picture.save(folder + QLatin1Char('/') + QLatin1String(name) + ".png"), "a picture for the guide is written");
}

/// How often a button was disabled.
class DisabledWatch : public QObject {
 public:
  explicit DisabledWatch(QWidget& button) { button.installEventFilter(this); }
  int times() const { return times_; }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override {
    if (event->type() == QEvent::EnabledChange && !static_cast<QWidget*>(watched)->isEnabled()) ++times_;
    return false;
  }

 private:
  int times_ = 0;
};

bool may_go_out() {
  return find<QPushButton>("palpateCorrectSave").isEnabled() && find<QPushButton>("palpateCorrectSend").isEnabled();
}

/// Opened, mended, undone, saved, read again.
void an_outline_is_corrected() {
  const glm::dvec3 pole = cap_is_traced();
  expect(find<QPushButton>("palpateMark").text().startsWith("Correct"), "M corrects");
  const auto is_felt = [&] { return std::abs(felt_mm(pole)) < 0.4; };
  wait_for("the corrected edge is felt where it was drawn: " + std::to_string(felt_mm(pole)), is_felt, 20);
  wait_for(
      "it is told what was changed", [] { return label("palpateCorrectChange").contains("mm at most"); }, 60);
  views_rest();
  expect(drawn_beside_felt(2) < 0.05, "what is drawn is what is felt: " + std::to_string(drawn_beside_felt(2)));
  expect(drawn_beside_felt(1) > 2, "the outline of the file is drawn beside it");
  save_screen("correct-traced");
  save_for_guide("correct", *pqCoreUtilities::mainWidget());
  save_for_guide("correct-tools", find<QWidget>("palpateCorrectBox"));
  hold_key_in(view("Axial"), "b", true);
  const bool shown = comes_true([] { return drawn_beside_felt(2) > 2 && std::isnan(drawn_beside_felt(1)); });
  expect(shown, "a key shows the file's outline: " + std::to_string(drawn_beside_felt(2)) + ", " +
                    std::to_string(drawn_beside_felt(1)) + ", " + label("palpateStructureMessage").toStdString() +
                    (has_edit("trace") ? "" : ", without an edit"));
  expect(label("palpateCorrectChange").contains("as it is in the file"), "which is said");
  hold_key_in(view("Axial"), "Shift_L", true);
  hold_key_in(view("Axial"), "b", false);
  hold_key_in(view("Axial"), "Shift_L", false);
  wait_for(
      "and lets it go, whatever else is held", [] { return drawn_beside_felt(2) < 0.05; }, 20);

  const double mended = felt_mm(pole);
  click("palpateCorrectUndo");
  wait_for(
      "one press undoes it", [] { return !has_edit("trace"); }, 20);
  wait_for(
      "what is felt is the file's outline", [&] { return felt_mm(pole) < -2; }, 20);
  click("palpateCorrectRedo");
  wait_for(
      "and redoes it, to the bit", [&] { return felt_mm(pole) == mended; }, 20);
  connect_stylus();
  wait_for(
      "the distance of the corrected outline is told",
      [] { return find<QLabel>("palpateDistance").isVisible() && label("palpateDistance").contains("Liver"); }, 20);

  const QString file = qEnvironmentVariable("PALPATE_CORRECTED");
  QFile::remove(file);
  const DisabledWatch sending(find<QPushButton>("palpateCorrectSend"));
  name_file("palpateCorrectSave", file);
  wait_for(
      "it is saved", [] { return label("palpateStructureMessage").contains("is written"); }, 60);
  expect(sending.times() == 1 && may_go_out(), "and nothing else goes out meanwhile");
  const auto found = palpate::io::find_structures(std::array{std::filesystem::path(file.toStdString())});
  expect(found.structures.size() == 1 && found.structures.front().name == "Liver", "it is read again, by its name");
  const auto read = palpate::io::load_distance(found.structures.front());
  expect(std::abs(read->sample(pole).mm) < 1, "with the traced edge: " + std::to_string(read->sample(pole).mm));
  const double saved_ml = palpate::io::measure(found.structures.front()).volume_mm3 / 1000;
  expect(
      std::abs(saved_ml - number("palpateCorrectChange")) < 0.3,
      "as large as it was told: " + std::to_string(saved_ml) + " ml, " + label("palpateCorrectChange").toStdString());
  views_rest();
  save_screen("correct-saved");
}

/// To the archive that the scan is in; archive_test.py looks what has come there.
void an_outline_is_sent() {
  cap_is_traced();
  wait_for(
      "it is told what was changed", [] { return label("palpateCorrectChange").contains("mm at most"); }, 60);
  in_dialog("palpateCorrectSend", [](QDialog& dialog) {
    expect(label("palpateSendPatient") == "Muster, Erika  ·  P1",
           "for whom: " + label("palpateSendPatient").toStdString());
    const QString what = label("palpateSendWhat");
    expect(what.startsWith("A segmentation (SEG) of Liver.") && what.contains("mm at most"),
           "what, and what has changed: " + what.toStdString());
    save_screen("correct-send");
    dialog.reject();
  });
  wait_ms(300);
  expect(label("palpateStructureMessage").isEmpty() && !find<QWidget>("palpateOutlineOut").isVisible(),
         "what is only looked at is not sent");
  in_dialog("palpateCorrectSend", [](QDialog&) { click("palpateSendOk"); });
  wait_for("it is sent", [] { return label("palpateStructureMessage") == "Sent to clinic: the corrected outline."; });
}

/// A ball is added to the outline: it is seen before where it is and how large.
void a_ball_is_added() {
  scan_is_shown();
  correct_the_liver();
  click("palpateToolAdd");
  const glm::dvec3 pole = on_the_edge(0, height_of_slice());
  const QColor brush(255, 240, 77);
  move_pointer(view("Axial"), pixel_of("Axial", pole));
  wait_for(
      "the ball is seen under the pointer, of 3 mm",
      [&] {
        const auto circles = lines_drawn_in("Axial", brush);
        return circles.size() == 1 && std::abs(circles.front().width_mm() - 6) < 0.1;
      },
      20);
  save_screen("correct-brush");
  drag(view("Axial"), pixel_of("Axial", pole), pixel_of("Axial", on_the_edge(15, pole.z)), true);
  wait_for("what it passed over is added", [] { return has_edit("add"); });
  wait_for("and felt", [&] { return std::abs(felt_mm(pole) - 3) < 0.7; });
  wait_for(
      "it is told how much", [] { return number("palpateCorrectChange") > 60; }, 60);
  click("palpateToolRemove");
  drag(view("Axial"), pixel_of("Axial", pole), pixel_of("Axial", on_the_edge(15, pole.z)), true);
  wait_for("and taken away again", [] { return has_edit("remove"); });
  wait_for("which is felt", [&] { return felt_mm(pole) < -2; });
}

/// A vessel in front of the cap is kept out of: the corrected outline comes nearer to it, which is told.
void margins_are_told() {
  constexpr double vessel_mm = 3;  // a ball of that radius, 30 mm in front of the other's middle
  const glm::dvec3 vessel(0, -30, 0);
  scan_is_shown();
  structures_are_listed(2);
  QTreeWidget& list = find<QTreeWidget>("palpateStructureList");
  const auto row_of = [&](const char* name) {
    return list.topLevelItem(list.topLevelItem(0)->text(0) == QLatin1String(name) ? 0 : 1);
  };
  list.setCurrentItem(row_of("Vessel"));
  click("palpateStructureKeepOut");
  wait_for("the vessel is kept out of", [] { return scene_text().find("keep_out") != std::string::npos; });
  list.setCurrentItem(row_of("Liver"));
  click("palpateCorrect");
  wait_for(
      "the cut cap is found", [] { return places().isVisible() && places().topLevelItemCount() > 0; }, 60);
  expect(!label("palpateCorrectChange").contains("Vessel"), "nothing is told before anything is corrected");
  expect(!find<QPushButton>("palpateCorrectSave").isEnabled() && !find<QPushButton>("palpateCorrectSend").isEnabled(),
         "what is not corrected does not go out");
  click(*places().viewport(), places().visualItemRect(places().topLevelItem(0)).center());
  views_rest();
  const double height = height_of_slice();
  trace_the_edge(height);
  wait_for(
      "the margin is told", [] { return label("palpateCorrectChange").contains("Distance to Vessel: "); }, 60);
  const QString told = label("palpateCorrectChange").split("Distance to Vessel: ").last();
  const double margin = told.split(' ').first().toDouble();
  // At the pole the traced edge is nearest to the vessel, or a little beside it, where it was not traced.
  const double expected = glm::distance(on_the_edge(0, height), vessel) - vessel_mm;
  expect(std::abs(margin - expected) < 0.7, "about " + std::to_string(expected) + " mm: " + told.toStdString());
  expect(margin < 30 - 21 - vessel_mm - 1, "less than that of the outline in the file");
  expect(told.contains("keep-out margin of Vessel is 3.0 mm wide"), "beside the keep-out's own: " + told.toStdString());
  wait_for("what is corrected may go out", may_go_out, 20);
  save_screen("correct-margins");
  click("palpateCorrect");
  expect(label("palpateDoubtfulNote").isEmpty(), "no places of the one before are told");
  expect(find<QPushButton>("palpateMark").text().startsWith("Mark"), "M marks again");
}

/// On the second of two frames: what was asked for on the first is not done to it, and the outline can be corrected.
void an_outline_is_corrected_on_a_frame() {
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  scan_is_shown();
  correct_the_liver();
  const QString first = places().topLevelItem(0)->text(1);
  auto& type = find<QComboBox>("palpateFilter");
  if (!type.isVisible()) click("palpateScanSectionFold");
  type.setCurrentIndex(type.findText("Non-local means"));
  emit type.activated(type.currentIndex());
  expect(find<QProgressBar>("palpateFiltering").isVisible(), "the first frame is being filtered");
  find<QSlider>("palpateFrame").setValue(1);
  wait_for(
      "the second frame is felt", [] { return label("palpateFelt").contains("2 of 2."); }, 20);
  expect(!find<QProgressBar>("palpateFiltering").isVisible() && type.currentText() == "None",
         "it is not filtered: " + type.currentText().toStdString());
  wait_for(
      "doubtful places are its own",
      [&] { return places().topLevelItemCount() > 0 && places().topLevelItem(0)->text(1) != first; }, 60);
  views_rest();
  const glm::dvec3 pole(0, -23, 0);
  expect(std::isfinite(felt_mm(pole)), "its outline is felt");
  click("palpateToolAdd");
  drag(view("Axial"), pixel_of("Axial", pole), pixel_of("Axial", pole + glm::dvec3(5, 0, 0)), true);
  wait_for("a ball is added", [] { return has_edit("add"); });
  wait_for("and may go out", may_go_out, 60);
  wait_for(
      "the surface is made, too", [] { return label("palpateCorrectChange").contains("mm at most"); }, 60);
  expect(scene_text().find("\"filter\"") == std::string::npos, "no filter has come since");
  save_screen("correct-frame");
}

/// How far to the front the outline's surface in the volume view reaches, mm.
double front_in_volume() {
  return -least_of_surface_in("Volume", color_of_liver()).y;
}

/// The pointer over the outline in the volume view: it goes to the scan's own edge. B shows there what was before, too.
void an_outline_is_traced_over_its_surface() {
  scan_is_shown();
  correct_the_liver();
  wait_for(
      "the outline's surface is drawn", [] { return std::abs(front_in_volume() - (ball_mm - cut_mm)) < 0.7; }, 60);
  views_rest();
  constexpr double from = -24, to = 24, step = 3;
  constexpr double box_mm = 32;  // from the middle of the scan to its sides
  QWidget& volume = view("Volume");
  const auto on_the_cut = [](double at) { return glm::dvec3(0.45 * at, cut_mm - ball_mm, 0.1 * at); };
  drag(volume, pixel_of("Volume", on_the_cut(from)), pixel_of("Volume", on_the_cut(from + step)), false);
  for (double at = from + 2 * step; at <= to; at += step) move_pointer(volume, pixel_of("Volume", on_the_cut(at)));
  let_go();
  wait_for("the stroke is an edit", [] { return has_edit("trace"); });
  const auto trace = std::get<palpate::io::TraceEdit>(edits_in_scene().front());
  double most = 0;
  for (const palpate::io::Vec3& at : trace.points_mm) most = std::fmax(most, std::abs(glm::length(at) - ball_mm));
  expect(trace.points_mm.size() > 5 && most < 0.5, "at the ball's own edge: " + std::to_string(most));
  expect(trace.known_to_mm.size() == trace.points_mm.size() && trace.known_to_mm.front() > 0,
         "with how well that is known");
  wait_for(
      "its surface reaches the ball's", [] { return std::abs(front_in_volume() - ball_mm) < 0.7; }, 60);
  views_rest();
  save_screen("correct-volume");
  hold_key_in(volume, "b", true);
  const bool shown = comes_true([] { return std::abs(front_in_volume() - (ball_mm - cut_mm)) < 0.7; });
  expect(shown, "a key shows the file's: " + std::to_string(front_in_volume()));
  hold_key_in(volume, "b", false);
  wait_for(
      "and lets it go", [] { return std::abs(front_in_volume() - ball_mm) < 0.7; }, 20);
  auto* const crop = pqCoreUtilities::mainWidget()->findChild<QAction*>(QStringLiteral("palpateCropBox"));
  crop->trigger();
  views_rest();
  const QPoint handle = pixel_of("Volume", glm::dvec3(0, -box_mm, 0));
  drag(volume, handle, handle + QPoint(40, 30), true);
  views_rest();
  expect(edits_in_scene().size() == 1, "a handle of the crop box is not the outline behind it");
  crop->trigger();
  find<QTreeWidget>("palpateStructureList").topLevelItem(0)->setCheckState(0, Qt::Unchecked);
  views_rest();
  drag(volume, pixel_of("Volume", on_the_cut(from)), pixel_of("Volume", on_the_cut(to)), true);
  views_rest();
  expect(edits_in_scene().size() == 1, "an outline that is not seen is not traced");
}

/// An outline in the middle of the ball, where nothing is to be felt: a stroke over it changes nothing, and it is said
/// why.
void an_outline_without_an_edge_stays() {
  constexpr double radius_mm = 12;
  scan_is_shown();
  structures_are_listed(1);
  click("palpateCorrect");
  wait_for("it is looked through", [] { return label("palpateDoubtfulNote") == "No doubtful place was found."; });
  wait_for(
      "its surface is drawn", [] { return std::abs(front_in_volume() - radius_mm) < 0.7; }, 60);
  views_rest();
  const std::string before = steady_scene();
  QWidget& volume = view("Volume");
  const auto on_it = [](double x) { return glm::dvec3(x, -std::sqrt(radius_mm * radius_mm - x * x), 0); };
  drag(volume, pixel_of("Volume", on_it(-5)), pixel_of("Volume", on_it(5)), true);
  wait_for("it is said",
           [] { return label("palpateStructureMessage") == "The scan has no edge there: the outline stays."; });
  expect(steady_scene() == before, "the outline stays");
  save_screen("correct-no-edge");
}

}  // namespace

const Scenarios& correct_scenarios() {
  static const Scenarios all{{"an_outline_is_corrected", an_outline_is_corrected},
                             {"a_ball_is_added", a_ball_is_added},
                             {"margins_are_told", margins_are_told},
                             {"an_outline_is_corrected_on_a_frame", an_outline_is_corrected_on_a_frame},
                             {"an_outline_is_traced_over_its_surface", an_outline_is_traced_over_its_surface},
                             {"an_outline_without_an_edge_stays", an_outline_without_an_edge_stays},
                             {"an_outline_is_sent", an_outline_is_sent}};
  return all;
}
