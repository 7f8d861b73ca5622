#include "plugin/paraview/tests/panel/PanelTest.h"

#include <QApplication>
#include <QListWidget>
#include <QTimer>
#include <QWidget>

#include <cstdio>
#include <exception>
#include <string>

#include "plugin/paraview/tests/panel/panel_rig.h"

namespace {

/// The folder that the program began with is on its way: what handles events then is not to be held up either.
bool is_opening() {
  if (qEnvironmentVariableIsEmpty("PALPATE_OPEN")) return false;
  const bool known = find<QListWidget>("palpateSeries").count() > 0 || !label("palpateMessage").isEmpty();
  return !known || find<QWidget>("palpateProgress").isVisible();
}

}  // namespace

void PanelTest::on_startup() {
  const std::string name = qgetenv("PALPATE_PANEL_TEST").toStdString();
  if (name.empty()) return;
  auto* const welcome = new QTimer(this);  // comes when it likes, in front of all else
  connect(welcome, &QTimer::timeout, this, [] {
    for (QWidget* const top : QApplication::topLevelWidgets()) {
      if (top->inherits("pqWelcomeDialog") && top->isVisible()) top->close();
    }
  });
  constexpr int often_ms = 200;
  if (name != "the_start_page_is_the_welcome") welcome->start(often_ms);
  // Not before the panel is there: ParaView handles events while it starts, and must not be held up in one of them.
  auto* const waiting = new QTimer(this);
  connect(waiting, &QTimer::timeout, this, [waiting, name] {
    // Programs for comparison run without the panel.
    const bool without = name.starts_with("without_");
    QWidget* const shown = widget(without ? "pqClientMainWindow" : "PalpatePanel");
    if (!shown || !shown->isVisible() || (!without && is_opening())) return;
    // ParaView handles events in the middle of loading a state file: an event handled then holds it up.
    if (name == "a_session_is_restored" && !find<QWidget>("palpateConnect").isEnabled()) return;
    waiting->stop();
    int result = 1;
    try {
      let_go();  // the program before may have ended in mid-press, on the same display
      run_scenario(name);
      std::printf("%s: passed\n", name.c_str());
      result = 0;
    } catch (const std::exception& failure) {
      save_screen(name + "-failed");
      std::printf("%s: FAILED: %s\n", name.c_str(), failure.what());
    }
    std::fflush(stdout);
    QTimer::singleShot(0, QCoreApplication::instance(), [result] { QCoreApplication::exit(result); });
  });
  constexpr int poll_ms = 100;
  waiting->start(poll_ms);
}
