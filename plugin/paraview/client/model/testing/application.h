#pragma once

/// The application object that Qt's timers and queued calls need.

#include <QCoreApplication>

#include <chrono>
#include <thread>

namespace palpate::plugin::testing {

/// It lives as long as the program.
inline QCoreApplication& application() {
  static int count = 1;
  static char name[] = "test";
  static char* arguments[] = {name, nullptr};
  static QCoreApplication made(count, arguments);
  return made;
}

/// A base of fixtures, constructed before their models: a timer that is started before the application never fires.
struct WithApplication {
  WithApplication() { application(); }
};

/// Whether the condition becomes true within a minute, while events are handled.
template <typename Holds>
bool comes(const Holds& holds) {
  application();
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < end) {
    QCoreApplication::processEvents();
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

}  // namespace palpate::plugin::testing
