// The guide's pictures, as the program looks while it is used.

#include <pqCoreUtilities.h>

#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QPixmap>
#include <QPushButton>
#include <QScreen>
#include <QThread>
#include <QToolButton>
#include <QWidget>
#include <QWindow>

#include <QGuiApplication>

#include "panel_rig.h"
#include "panel_steps.h"

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
  for (const char* const other :
       {"palpateScanSection", "palpateTissuesSection", "palpateStylusSection", "palpateCurvesSection",
        "palpateModesSection", "palpateProfileSection", "palpateRecordingsSection"}) {
    if (widget(other)) fold(other, other == std::string(section));
  }
  save_widget(name, section);
}

/// As wide as a person would make it to read what is in it, in a window of the whole screen.
void arrange() {
  QWidget& window = *pqCoreUtilities::mainWidget();
  window.setGeometry(QGuiApplication::primaryScreen()->geometry());
  wait_ms(1500);
}

void guide_pictures() {
  expect(!qEnvironmentVariable("PALPATE_GUIDE").isEmpty(), "PALPATE_GUIDE names a folder for the pictures");
  arrange();
  feel();
  for (const char* const section : {"palpateScanSection"}) fold(section, false);
  save("panel", QGuiApplication::primaryScreen()->geometry());
  save_widget("footer", "palpateFooter");
  let_go();
  save_section("tissues", "palpateTissuesSection");
  save_section("boundary", "palpateCurvesSection");
  fold("palpateProfileSection", true);
  click("palpateProfilePick");
  QWidget& sagittal = view("Sagittal");
  const int height = sagittal.height() / 2;
  drag(sagittal, QPoint(sagittal.width() / 12, height), QPoint(sagittal.width() / 3, height), true);
  wait_for("a boundary is met", [] { return label("palpateProfileReadout").contains("up to"); });
  save_section("profile", "palpateProfileSection");
  save_section("stylus", "palpateStylusSection");
  QThread::sleep(3);  // as if the program hung: the servo takes the force away
  wait_for("the fault is told", [] { return find<QPushButton>("palpateFeel").text() == "Clear fault"; });
  save_section("fault", "palpateStylusSection");
  click("palpateFeel");
  wait_for("forces are on again", [] { return label("palpateState").startsWith("active"); });
  press_key(Qt::Key_Escape);
  wait_for("it is released", [] { return label("palpateState").startsWith("released"); });
  save_section("released", "palpateStylusSection");
}

}  // namespace

const Scenarios& picture_scenarios() {
  static const Scenarios scenarios{{"guide_pictures", guide_pictures}};
  return scenarios;
}
