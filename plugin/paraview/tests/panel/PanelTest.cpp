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
  QTimer::singleShot(1000, this, [name] {
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
}
