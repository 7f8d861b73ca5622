#include "PanelTest.h"

#include <QCoreApplication>
#include <QTimer>

#include <cstdio>
#include <exception>
#include <string>

#include "panel_rig.h"

void PanelTest::on_startup() {
  const std::string name = qgetenv("PALPATE_PANEL_TEST").toStdString();
  if (name.empty()) return;
  // Not before the panel is there: ParaView handles events while it starts, and must not be held up in one of them.
  auto* const waiting = new QTimer(this);
  connect(waiting, &QTimer::timeout, this, [waiting, name] {
    QWidget* const panel = widget("PalpatePanel");
    if (!panel || !panel->isVisible()) return;
    waiting->stop();
    int result = 1;
    try {
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
  constexpr int poll_ms = 1000;
  waiting->start(poll_ms);
}
