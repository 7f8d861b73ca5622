// The clinical layout: the parts on the screen, their places, and enlarged views.

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqDataRepresentation.h>
#include <pqPropertiesPanel.h>
#include <pqProxyWidget.h>
#include <pqRenderView.h>
#include <pqServer.h>
#include <pqServerManagerModel.h>
#include <vtkSMProxy.h>
#include <vtkSMRepresentationProxy.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMViewProxy.h>
#include <QGuiApplication>
#include <QScreen>

#include <QAction>
#include <QComboBox>
#include <QDockWidget>
#include <QFile>
#include <QFileInfo>
#include <QImage>
#include <QListWidget>
#include <QMainWindow>
#include <QMenu>
#include <QPushButton>
#include <QScrollArea>
#include <QStringList>
#include <QTextBrowser>
#include <QTextDocument>
#include <QToolBar>
#include <QToolButton>
#include <QUrl>

#include <algorithm>
#include <cmath>
#include <string>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

QMainWindow& whole_window() {
  return *qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
}

template <typename Widget>
QStringList shown() {
  QStringList names;
  for (const Widget* const one : whole_window().findChildren<Widget*>(QString(), Qt::FindDirectChildrenOnly)) {
    if (one->isVisible()) names << one->objectName();
  }
  names.sort();
  return names;
}

QRect on_screen(const QWidget& of) {
  return {of.mapToGlobal(QPoint(0, 0)), of.size()};
}

/// Whether the whole widget is visible, in the window and in every scroll area around it.
bool is_all_in_sight(const char* name) {
  QWidget& of = find<QWidget>(name);
  const QRect place = on_screen(of);
  if (!of.isVisible() || !on_screen(whole_window()).contains(place)) return false;
  for (QWidget* above = of.parentWidget(); above; above = above->parentWidget()) {
    auto* const scroll = qobject_cast<QScrollArea*>(above);
    if (scroll && !on_screen(*scroll->viewport()).contains(place)) return false;
  }
  return true;
}

void expect_all_in_sight(const char* name) {
  expect(is_all_in_sight(name), std::string(name) + " is in the window, and not scrolled away");
}

/// A file with a scene of five surfaces.
QString five_tissues() {
  QString modes;
  for (int n = 0; n < 5; ++n) {
    modes += QStringLiteral(R"(%1{"type": "surface", "name": "tissue %2", "strength_n": %2})")
                 .arg(n == 0 ? "" : ", ")
                 .arg(n + 1);
  }
  const QString name = qEnvironmentVariable("PALPATE_PICTURES") + QStringLiteral("/five tissues.json");
  QFile file(name);
  const QByteArray text = QStringLiteral(R"({"version": 1, "modes": [%1]})").arg(modes).toUtf8();
  expect(file.open(QIODevice::WriteOnly) && file.write(text) == text.size(), "the scene is written");
  return name;
}

/// PALPATE_POINTS: the size of the screen in points.
void the_panel_fits_the_screen() {
  scan_is_shown();
  const QSize points = QGuiApplication::primaryScreen()->size();
  const QString size = QStringLiteral("%1x%2").arg(points.width()).arg(points.height());
  expect(size == qEnvironmentVariable("PALPATE_POINTS"), "the screen has these points: " + size.toStdString());
  whole_window().setGeometry(QRect({0, 0}, points));
  name_file("palpateOpenScene", five_tissues());
  wait_for(
      "five tissues are listed", [] { return widget("palpateOn4") && widget("palpateOn4")->isVisible(); }, 10);
  connect_stylus();
  for (const char* const name :
       {"palpateConnect", "palpateOn0", "palpateStrength0", "palpateOn1", "palpateStrength1", "palpateOn2",
        "palpateStrength2", "palpateOn3", "palpateStrength3", "palpateOn4", "palpateStrength4", "palpateFooter",
        "palpateRelease", "palpateToolbarConnectButton", "palpateToolbarRelease"}) {
    wait_for(
        std::string(name) + " is in the window, and not scrolled away", [&] { return is_all_in_sight(name); }, 5);
  }
  save_screen("fits-" + std::to_string(view("Axial").devicePixelRatio()) + "-" + size.toStdString());
}

void expect_host(bool there, const char* when) {
  const bool comes = comes_true([there] {
    const bool toolbars = shown<QToolBar>().size() > 1;
    const bool pipeline = shown<QDockWidget>().contains(QStringLiteral("pipelineBrowserDock"));
    return toolbars == there && pipeline == there;
  });
  expect(comes, std::string(when) + " ParaView's own is " + (there ? "there" : "hidden") + ": toolbars " +
                    shown<QToolBar>().join(", ").toStdString() + "; docks " +
                    shown<QDockWidget>().join(", ").toStdString());
}

int views_in_sight() {
  int count = 0;
  for (const char* const name : {"Axial", "Sagittal", "Coronal", "Volume"}) count += view(name).isVisible() ? 1 : 0;
  return count;
}

/// A number that changes if the views are made anew.
unsigned views_made() {
  unsigned sum = 0;
  for (const auto* const one : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>()) {
    sum += one->getProxy()->GetGlobalID();
  }
  return sum;
}

void double_click(const char* name) {
  QWidget& in = view(name);
  double_click(in, QPoint(in.width() / 4, in.height() * 3 / 4));
}

/// ParaView's *Properties* show the active representation as soon as they are visible.
void expect_properties_of_the_active() {
  const auto& panel = *whole_window().findChild<pqPropertiesPanel*>();
  wait_for(
      "Properties show what is active",
      [&] {
        const pqDataRepresentation* const active = pqActiveObjects::instance().activeRepresentation();
        return active && std::ranges::any_of(panel.findChildren<pqProxyWidget*>(), [&](const pqProxyWidget* one) {
                 return one->proxy() == active->getProxy();
               });
      },
      20);
}

/// Hidden *Properties* with a view or representation would keep it in memory when the scan is closed.
void expect_properties_hold_no_view() {
  const auto& panel = *whole_window().findChild<pqPropertiesPanel*>();
  wait_for(
      "hidden Properties hold no view and no representation",
      [&] {
        return std::ranges::none_of(panel.findChildren<pqProxyWidget*>(), [](const pqProxyWidget* one) {
          return vtkSMViewProxy::SafeDownCast(one->proxy()) || vtkSMRepresentationProxy::SafeDownCast(one->proxy());
        });
      },
      20);
}

/// *Advanced* shows and hides ParaView's own parts. They show what became active while they were hidden.
void advanced_shows_the_host() {
  click("palpateAdvancedButton");
  expect_host(true, "under Advanced");
  expect_properties_of_the_active();
  wait_for("Properties stand in front", [] { return !find<QWidget>("propertiesDock").visibleRegion().isEmpty(); });
  save_screen("layout-advanced");
  pqActiveObjects::instance().setActiveView(&render_view("Sagittal"));
  expect_properties_of_the_active();
  click("palpateAdvancedButton");
  expect_host(false, "without Advanced");
  expect_properties_hold_no_view();
  pqActiveObjects::instance().setActiveView(&render_view("Coronal"));
  click("palpateAdvancedButton");  // stays on for advanced_is_remembered()
  expect_properties_of_the_active();
}

/// On a small laptop's screen.
void the_layout_is_clinical() {
  scan_is_shown();
  whole_window().setGeometry(QGuiApplication::primaryScreen()->geometry());
  is_laid_out(whole_window());
  views_rest();
  expect_host(false, "at first");
  expect(shown<QToolBar>() == QStringList("palpateToolbar"), "one toolbar is there");
  expect(shown<QDockWidget>() == QStringList("PalpatePanel"), "and the panel");
  expect(find<QPushButton>("palpateToolbarRelease").height() >= 30, "Release is big");
  expect(!find<QPushButton>("palpateToolbarRelease").isEnabled(), "there is nothing to release");
  for (const char* const name :
       {"palpateOn0", "palpateStrength0", "palpateOn2", "palpateStrength2", "palpateConnect", "palpateFooter",
        "palpateRelease", "palpateToolbarOpenButton", "palpateWindow", "palpateFourUpButton", "palpateOneUpButton",
        "palpateToolbarConnectButton", "palpateToolbarRelease", "palpateAdvancedButton"}) {
    expect_all_in_sight(name);
  }
  save_screen("layout");
  const auto key_of = [](const char* name) {
    const auto* const of = whole_window().findChild<QAction*>(QLatin1String(name));
    expect(of != nullptr, std::string("there is an action ") + name);
    return of->shortcut();
  };
  expect(key_of("actionFileSaveServerState") == QKeySequence(QKeySequence::Save), "Ctrl+S saves the state");
  expect(key_of("actionFileSaveData").isEmpty(), "and nothing else");

  expect(views_in_sight() == 4, "four views are in sight");
  const int wide = view("Axial").width();
  double_click("Axial");
  wait_for(
      "the view is enlarged", [&] { return views_in_sight() == 1 && view("Axial").width() > 1.8 * wide; }, 20);
  expect(find<QToolButton>("palpateOneUpButton").isChecked(), "the toolbar says so");
  is_laid_out(view("Axial"));
  save_screen("layout-one-up");
  double_click("Axial");
  wait_for("all are there again", [] { return views_in_sight() == 4; });
  expect(find<QToolButton>("palpateFourUpButton").isChecked(), "the toolbar says so");
  click("palpateOneUpButton");
  wait_for(
      "the marked view is alone", [] { return views_in_sight() == 1; }, 20);
  click("palpateFourUpButton");
  wait_for(
      "all are there again", [] { return views_in_sight() == 4; }, 20);

  click("palpateToolbarConnectButton");
  turn_forces_on();
  expect(find<QToolButton>("palpateToolbarConnectButton").text() == "Disconnect stylus",
         "the toolbar knows, and says what");
  click("palpateToolbarRelease");
  wait_for(
      "it is released", [] { return label("palpateState").startsWith("Ready"); }, 20);

  auto& windows = find<QComboBox>("palpateWindow");
  const int named = windows.count();
  QWidget& axial = view("Axial");
  drag(axial, QPoint(axial.width() / 4, axial.height() * 3 / 4), QPoint(axial.width() / 3, axial.height() * 3 / 4),
       true);
  wait_for(
      "the box says that the window is nobody's", [&] { return windows.currentText().startsWith("Custom ("); }, 20);
  windows.setCurrentIndex(0);
  emit windows.activated(0);
  expect(windows.count() == named && windows.currentIndex() == 0, "and that it is a named one again");

  advanced_shows_the_host();
}

/// In the program's next start.
void advanced_is_remembered() {
  scan_is_shown();
  expect_host(true, "as it was left");
  expect(find<QToolButton>("palpateAdvancedButton").isChecked(), "the toolbar says so");
}

/// The windows, the pictures, the guide and the recent folder work, and so does saving a scene.
void ones_way_is_found() {
  scan_is_shown();
  QWidget& axial = view("Axial");
  auto& windows = find<QComboBox>("palpateWindow");
  expect(windows.count() >= 8, "there are windows for eight keys");
  press_key_in(axial, "2");
  wait_for(
      "the key 2 chooses the second window", [&] { return windows.currentIndex() == 1; }, 20);
  expect(comes_true([] { return corner_text("Axial").contains("W 80  L 40"); }),
         "the slices have it: " + corner_text("Axial").toStdString());
  press_key_in(axial, "1");
  wait_for(
      "the key 1 the first", [&] { return windows.currentIndex() == 0; }, 20);

  const QString picture = qEnvironmentVariable("PALPATE_PICTURES") + QStringLiteral("/views");
  QFile::remove(picture + ".png");
  name_file("palpatePictureButton", picture);
  const QImage all(picture + ".png");
  expect(all.width() > 1.8 * axial.width() && all.height() > 1.8 * axial.height(), "the picture is of all views");
  click("palpateOneUpButton");
  wait_for(
      "one view is alone", [] { return views_in_sight() == 1; }, 20);
  is_laid_out(view("Axial"));
  QFile::remove(picture + ".png");  // else the program asks whether to replace the file
  name_file("palpatePictureButton", picture);
  const QImage one(picture + ".png");
  expect(std::abs(one.width() - view("Axial").width()) < 8, "the picture is of that view");
  click("palpateFourUpButton");

  const QString scene = qEnvironmentVariable("PALPATE_PICTURES") + QStringLiteral("/my own");
  QFile::remove(scene + ".json");
  name_file("palpateSaveScene", scene);
  expect(QFile::exists(scene + ".json"), "a scene is saved with its suffix");

  press_key_in(view("Coronal"), "F1");
  wait_for(
      "F1 opens the guide", [] { return widget("palpateGuide") && widget("palpateGuide")->isVisible(); }, 20);
  auto& guide = find<QTextBrowser>("palpateGuideText");
  expect(guide.toPlainText().contains("First five minutes"), "which is there without a network");
  expect(!guide.document()->resource(QTextDocument::ImageResource, QUrl("pictures/panel.png")).isNull(),
         "with its pictures");
  wait_ms(500);
  save_screen("guide");
  widget("palpateGuide")->close();

  QMenu& recent = *whole_window().findChild<QMenu*>("palpateRecent");
  emit recent.aboutToShow();
  const QString folder = QFileInfo(qEnvironmentVariable("PALPATE_OPEN")).absoluteFilePath();
  expect(recent.actions().size() == 1 && recent.actions().first()->text() == folder, "the folder is remembered");
  const unsigned before = views_made();
  recent.actions().first()->trigger();
  wait_for(
      "and opened again", [&] { return views_made() != before; }, 60);
  scan_is_shown();
}

int tabs() {
  auto* const server = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqServer*>().first();
  return static_cast<int>(server->proxyManager()->GetNumberOfProxies("layouts"));
}

/// Every scan that is opened is shown in the same tab, and leaves no empty frame behind.
void one_tab_is_used_again() {
  auto& series = find<QListWidget>("palpateSeries");
  wait_for("the series are listed", [&] { return series.count() > 1; });
  for (const int row : {0, 1, 0}) {
    is_laid_out(*series.viewport());
    const unsigned before = reader_in_pipeline();
    click(*series.viewport(), series.visualItemRect(series.item(row)).center());
    another_scan_is_shown(before);
    expect(tabs() == 1, "there is one tab: " + std::to_string(tabs()));
    expect(views_in_sight() == 4, "with four views");
    const auto views = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>();
    expect(views.size() == 4, "and no other: " + std::to_string(views.size()));
    click("palpateScanSectionFold");
  }
}

}  // namespace

const Scenarios& layout_scenarios() {
  static const Scenarios scenarios{{"the_layout_is_clinical", the_layout_is_clinical},
                                   {"the_panel_fits_the_screen", the_panel_fits_the_screen},
                                   {"advanced_is_remembered", advanced_is_remembered},
                                   {"ones_way_is_found", ones_way_is_found},
                                   {"one_tab_is_used_again", one_tab_is_used_again}};
  return scenarios;
}
