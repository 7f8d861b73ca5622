// The user is asked once about unsaved work before another scan or the end discards it; work is kept if the user could
// not be asked.

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqDeleteReaction.h>
#include <pqStandardRecentlyUsedResourceLoaderImplementation.h>

#include <QAction>
#include <QApplication>
#include <QCoreApplication>
#include <QDialog>
#include <QDoubleSpinBox>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QFile>
#include <QFileInfo>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QMimeData>
#include <QTimer>
#include <QUrl>

#include <functional>
#include <string>

#include "plugin/paraview/tests/panel/mark_steps.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

void set_strength(double newtons) {
  const std::string before = scene_text();
  find<QDoubleSpinBox>("palpateStrength0").setValue(newtons);
  wait_for(
      "the edit is in the scene", [&] { return scene_text() != before; }, 20);
}

bool holds(const QString& file, const char* text) {
  QFile read(file);
  return read.open(QIODevice::ReadOnly) && read.readAll().contains(text);
}

/// In the file dialog that follows, as soon as it is there.
void in_next_file_dialog(const std::function<void(QDialog& dialog, QLineEdit& name)>& act) {
  auto* const looking = new QTimer(pqCoreUtilities::mainWidget());
  QObject::connect(looking, &QTimer::timeout, looking, [looking, act] {
    for (auto* const dialog : pqCoreUtilities::mainWidget()->findChildren<QDialog*>()) {
      auto* const name = dialog->findChild<QLineEdit*>(QStringLiteral("fileNameEdit"));
      if (!name || !dialog->isVisible()) continue;
      looking->stop();
      looking->deleteLater();
      return act(*dialog, *name);
    }
  });
  constexpr int poll_ms = 200;
  looking->start(poll_ms);
}

/// Rejects the next dialog whose title has these words.
void reject_dialog_of(const QString& title) {
  auto* const looking = new QTimer(pqCoreUtilities::mainWidget());
  QObject::connect(looking, &QTimer::timeout, looking, [looking, title] {
    auto* const dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
    if (!dialog || !dialog->windowTitle().contains(title)) return;
    looking->stop();
    looking->deleteLater();
    dialog->reject();
  });
  constexpr int poll_ms = 200;
  looking->start(poll_ms);
}

void name_state(const QString& file) {
  QFile::remove(file);
  in_next_file_dialog([file](QDialog& dialog, QLineEdit& name) {
    name.setText(file);
    QMetaObject::invokeMethod(&dialog, "accept");
  });
}

/// In ParaView's menu of recent files.
void choose_recent(const QString& state) {
  QWidget& window = *pqCoreUtilities::mainWidget();
  pqStandardRecentlyUsedResourceLoaderImplementation::addStateFileToRecentResources(
      pqActiveObjects::instance().activeServer(), state);
  auto* const menu = window.findChild<QMenu*>(QStringLiteral("menuRecentFiles"));
  expect(menu != nullptr, "there is a menu of recent files");
  emit menu->aboutToShow();
  for (QAction* const action : menu->actions()) {
    if (action->text().contains(QFileInfo(state).fileName())) return action->trigger();
  }
  expect(false, "the state is in it");
}

void drop_on_window(const QString& file) {
  QMimeData dropped;
  dropped.setUrls({QUrl::fromLocalFile(file)});
  QDragEnterEvent enter(QPoint(1, 1), Qt::CopyAction, &dropped, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(pqCoreUtilities::mainWidget(), &enter);
  expect(enter.isAccepted(), "ParaView takes what is dropped on its window");
  QDropEvent event(QPointF(1, 1), Qt::CopyAction, &dropped, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(pqCoreUtilities::mainWidget(), &event);
}

void another_scan_is_asked_about() {
  choose_series(0);
  choose_series(1);  // nothing was edited: nothing is asked
  connect_stylus();
  press_key_in(view("Coronal"), "m");
  has_rows(1, "a mark");
  choose_series(0);  // it waits for its scan
  choose_series(1);
  has_rows(1, "and is there again");

  set_strength(0.65);
  const std::string edited = scene_text();
  const unsigned first = reader_in_pipeline();
  in_dialog_of(
      "a folder that is dropped",
      [] {
        drop_folder(qEnvironmentVariable("PALPATE_OPEN"));
        wait_ms(1000);
      },
      [](QDialog& question) {
        save_screen("unsaved-scan");
        expect(answer(question, "Cancel") == "Another scan is about to replace this one. Not saved: the edited scene.",
               "it is said what would be lost");
      });
  wait_ms(500);
  expect(reader_in_pipeline() == first && scene_text() == edited, "what is not wanted is not done");
  choose_series_and(0, "Cancel");
  wait_ms(500);
  expect(reader_in_pipeline() == first && scene_text() == edited, "nor for a series of the list");

  const QString file = beside_pictures("unsaved.pvsm");
  name_state(file);
  choose_series_and(0, "Save");
  another_scan_is_shown(first);
  expect(holds(file, "0.65"), "the edited scene is in the state");
  const unsigned second = reader_in_pipeline();
  set_strength(0.75);
  choose_series_and(1, "Discard");
  another_scan_is_shown(second);
  expect(scene_text().find("0.75") == std::string::npos, "another scan has its own scene");
  expect_four_views_of_one_scan();

  // What was saved comes back, and is asked about only where it is edited again.
  load_state(file);
  expect(scene_text() == edited, "the saved scene is back");
  drop_folder(qEnvironmentVariable("PALPATE_OPEN"));
  choose_series(1);
}

/// The window is closed, or File > Exit chosen: the same question, and once.
void the_end_is_asked_about() {
  scan_is_shown();
  QWidget& window = *pqCoreUtilities::mainWidget();
  connect_stylus();
  mark_three();
  set_strength(0.65);
  in_dialog_of(
      "the window's close button", [&] { window.close(); },
      [](QDialog& question) {
        save_screen("unsaved-end");
        expect(answer(question, "Cancel") == "ParaView is about to end. Not saved: the edited scene, 3 marks.",
               "it is said what would be lost");
      });
  expect(window.isVisible(), "the program goes on");
  for (const char* const action : {"actionFileExit", "actionFileLoadServerState", "actionDelete_All"}) {
    auto* const chosen = window.findChild<QAction*>(QLatin1String(action));
    expect(chosen != nullptr, std::string(action) + " is in the menus");
    in_dialog_of(
        action, [&] { chosen->trigger(); }, [](QDialog& question) { answer(question, "Cancel"); });
    wait_ms(300);
    expect(window.isVisible() && reader_in_pipeline() != 0, "all stays as it is");
  }
  const QString saved = beside_pictures("unsaved-recent.pvsm");
  QFile(saved).open(QIODevice::WriteOnly);
  in_dialog_of(
      "a state among the recent files", [&] { choose_recent(saved); },
      [](QDialog& question) { answer(question, "Cancel"); });
  for (const QString& dropped : {saved, beside_pictures("a picture with a state.png")}) {
    in_dialog_of(
        "a state that is dropped", [&] { drop_on_window(dropped); },
        [](QDialog& question) { answer(question, "Cancel"); });
  }
  wait_ms(300);
  expect(window.isVisible() && reader_in_pipeline() != 0, "no state takes the place of what is open");
  reject_dialog_of("Load State");
  in_dialog_of(
      "a state that is not chosen after all",
      [&] { window.findChild<QAction*>(QStringLiteral("actionFileLoadServerState"))->trigger(); },
      [](QDialog& question) { answer(question, "Discard"); });
  wait_ms(300);
  expect(window.isVisible() && reader_in_pipeline() != 0, "all is still open, and asked about again");
  in_next_file_dialog([](QDialog& dialog, QLineEdit&) { dialog.reject(); });
  in_dialog_of(
      "closing once more", [&] { window.close(); }, [](QDialog& question) { answer(question, "Save"); });
  expect(window.isVisible(), "who names no file has not saved, and the program goes on");

  const QString file = beside_pictures("unsaved-end.pvsm");
  name_state(file);
  in_dialog_of(
      "closing", [&] { window.close(); }, [](QDialog& question) { answer(question, "Save"); });
  expect(!window.isVisible(), "the program ends once all is saved");
  expect(holds(file, "0.65") && holds(file, "Mark 3"), "the state has scene and marks");
}

/// A session that a script ends is kept in a file, and it is said where.
void a_session_that_ends_is_kept() {
  scan_is_shown();
  set_strength(0.65);
  const std::string edited = scene_text();
  pqDeleteReaction::deleteAll();
  wait_for("ParaView has a session again", [] { return pqActiveObjects::instance().activeServer() != nullptr; });
  const QString said = label("palpateStartMessage");
  const QString begins = "ParaView's session ended. Not saved was: the edited scene. It is kept in ";
  expect(said.startsWith(begins) && said.endsWith(": File > Load State."), "it is said: " + said.toStdString());
  const QString file = said.mid(begins.size()).chopped(QString(": File > Load State.").size());
  expect(holds(file, "0.65"), "the scene is in " + file.toStdString());
  wait_ms(1000);
  save_screen("unsaved-kept");
  load_state(file);
  expect(scene_text() == edited, "it comes back");
  expect_four_views_of_one_scan();
  connect_stylus();
}

}  // namespace

const Scenarios& unsaved_scenarios() {
  static const Scenarios all{{"another_scan_is_asked_about", another_scan_is_asked_about},
                             {"the_end_is_asked_about", the_end_is_asked_about},
                             {"a_session_that_ends_is_kept", a_session_that_ends_is_kept}};
  return all;
}
