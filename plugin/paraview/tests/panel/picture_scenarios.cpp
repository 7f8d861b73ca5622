// The guide's pictures of the program in use.

#include <pqCoreUtilities.h>

#include <QDockWidget>
#include <QFile>
#include <QMainWindow>
#include <QPixmap>
#include <QPushButton>
#include <QScreen>
#include <QSlider>
#include <QToolButton>
#include <QTreeWidget>
#include <QWidget>
#include <QWindow>

#include <QGuiApplication>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// What is on the screen there: views and charts, which draw themselves, too.
void save(const char* name, const QRect& on_screen) {
  wait_ms(600);
  const QPixmap picture = QGuiApplication::primaryScreen()->grabWindow(0, on_screen.x(), on_screen.y(),
                                                                       on_screen.width(), on_screen.height());
  const QString file = qEnvironmentVariable("PALPATE_GUIDE") + QLatin1Char('/') + QLatin1String(name) + ".png";
  expect(picture.save(file), file.toStdString() + " is written");
}

QRect place_of(const QWidget& of) {
  return {of.mapToGlobal(QPoint(0, 0)), of.size()};
}

void save_widget(const char* name, const char* widget_name) {
  QWidget& shown = find<QWidget>(widget_name);
  scroll_to(shown);
  save(name, place_of(shown));
}

void fold(const char* section, bool open) {
  auto& header = find<QToolButton>((std::string(section) + "Fold").c_str());
  if (header.isChecked() != open) header.click();
  wait_ms(200);
}

/// One section alone, from its heading to the end of what is in sight of it.
void save_section(const char* name, const char* section) {
  for (QToolButton* const header : pqCoreUtilities::mainWidget()->findChildren<QToolButton*>()) {
    const QString fold_name = header->objectName();
    if (!fold_name.endsWith("SectionFold")) continue;
    fold(fold_name.chopped(4).toStdString().c_str(), fold_name == QString(section) + "Fold");
  }
  save_widget(name, section);
}

/// As much of the screen as a small laptop has, for the whole; more for the sections, so that each is seen to its end.
void arrange(const QSize& size, int panel_width) {
  auto& window = *qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
  window.setGeometry(QRect({0, 0}, size));
  for (QWidget* above = &find<QWidget>("palpateFooter"); above; above = above->parentWidget()) {
    if (auto* const dock = qobject_cast<QDockWidget*>(above)) window.resizeDocks({dock}, {panel_width}, Qt::Horizontal);
  }
  wait_ms(1500);
}

void guide_pictures() {
  const QString folder = qEnvironmentVariable("PALPATE_GUIDE");
  expect(!folder.isEmpty(), "PALPATE_GUIDE names a folder for the pictures");
  const QString recording = qEnvironmentVariable("PALPATE_PICTURES") + "/press.h5";
  QFile::remove(recording);
  arrange({1366, 768}, 340);
  scan_is_shown();
  connect_stylus();
  wait_ms(1500);
  name_file("palpateRecord", recording);
  press();
  fold("palpateScanSection", false);
  save("panel", QRect(0, 0, 1366, 768));
  save_widget("footer", "palpateFooter");
  let_go();
  click("palpateRecord");
  wait_for(
      "the recording is open", [] { return label("palpateRecordingName") == "press.h5"; }, 20);

  arrange(QGuiApplication::primaryScreen()->size(), 460);
  save_section("tissues", "palpateTissuesSection");
  save_section("boundary", "palpateCurvesSection");
  fold("palpateProfileSection", true);
  click("palpateProfilePick");
  QWidget& axial = view("Axial");
  drag(axial, QPoint(axial.width() / 2, axial.height() / 20), QPoint(axial.width() / 2, axial.height() * 2 / 5), true);
  wait_for("a boundary is met", [] { return label("palpateProfileReadout").contains("up to"); });
  save_section("profile", "palpateProfileSection");
  save_section("stylus", "palpateStylusSection");
  click("palpateConnect");
  auto& slider = find<QSlider>("palpateScrub");
  slider.setValue(slider.maximum() * 9 / 10);
  save_section("recordings", "palpateRecordingsSection");
}

/// Of a scan with a segmentation.
void guide_structures() {
  arrange({1366, 768}, 420);
  scan_is_shown();
  fold("palpateScanSection", false);
  fold("palpateStructuresSection", true);
  auto& list = find<QTreeWidget>("palpateStructureList");
  wait_for(
      "the structure is measured",
      [&] { return list.topLevelItemCount() == 1 && !list.topLevelItem(0)->text(1).isEmpty(); }, 60);
  list.setCurrentItem(list.topLevelItem(0));
  click("palpateStructureKeepOut");
  wait_for(
      "it is kept out of", [] { return steady_scene().find("keep_out") != std::string::npos; }, 20);
  views_rest();
  save("structures", QRect(0, 0, 1366, 768));
}

void guide_fault() {
  scan_is_shown();
  connect_stylus();
  hang();  // the servo takes the force away
  wait_for("the fault is told", [] { return find<QPushButton>("palpateFeel").text() == "Clear fault"; });
  arrange(QGuiApplication::primaryScreen()->size(), 460);
  save_widget("fault", "palpateFooter");
}

}  // namespace

const Scenarios& picture_scenarios() {
  static const Scenarios scenarios{
      {"guide_pictures", guide_pictures}, {"guide_structures", guide_structures}, {"guide_fault", guide_fault}};
  return scenarios;
}
