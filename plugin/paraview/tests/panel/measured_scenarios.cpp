#include <pqRenderView.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>

#include <QApplication>
#include <QCheckBox>
#include <QCursor>
#include <QElapsedTimer>
#include <QEvent>
#include <QEventLoop>
#include <QGuiApplication>
#include <QImage>
#include <QPixmap>
#include <QPushButton>
#include <QScreen>
#include <QTimer>

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "plugin/paraview/client/views/caster.h"
#include "plugin/paraview/client/views/event_watch.h"
#include "plugin/paraview/tests/panel/busy_watch.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

// Measurements: how long the main thread is busy, how long the first pictures take, and what the program takes at rest.
namespace {

/// Not a test but a measurement: how long the main thread is busy at a stretch while the user probes. ParaView
/// updates slices before it renders them. This time is left out only if slices do not follow.
void main_thread() {
  feel();
  QWidget& sagittal = view("Sagittal");
  const QPoint from = proxy_in(sagittal);
  // Not with a separate program: to start one keeps this thread busy for longer than the panel does.
  const auto point_at = [&](int x, int y) { QCursor::setPos(sagittal.mapToGlobal(from + QPoint(x, y))); };
  const auto print_events = [](const BusyWatch& watch) {
    const std::vector<double> events = watch.events_ms();
    std::printf(
        "main_thread: from an event to the next, of a processor, at most %.1f ms, one in a hundred %.1f ms or more\n",
        events.at(0), events.at(events.size() / 100));
  };
  for (const bool follow : {true, false}) {
    find<QCheckBox>("palpateFollow").setChecked(follow);
    const BusyWatch watch;
    for (int n = 0; n < 240; ++n) {
      point_at(10, std::abs(n % 120 - 60) - 30);
      wait_ms(30);
    }
    const std::vector<double> stretches = watch.without_rendering();
    std::printf(
        "main_thread: probing, slices %s: %zu stretches of events; without rendering the longest took %.1f ms, one in "
        "a hundred %.1f ms or more; with ParaView's rendering the longest took %.1f ms\n",
        follow ? "follow" : "stay", stretches.size(), stretches.at(0), stretches.at(stretches.size() / 100),
        watch.longest_with_rendering_ms());
    print_events(watch);
  }
  const BusyWatch watch;
  QElapsedTimer clock;
  double full_s = 0, longest_s = 0;
  bool had_rows_left = false;
  // Only the first picture counts. If the hand still creeps a little, another picture comes later.
  const palpate::plugin::EventWatch drawn(
      render_view("Volume").getRenderViewProxy()->GetRenderer(), vtkCommand::EndEvent, [&] {
        const bool has_rows_left = caster_of_the_volume().has_rows_left();
        if (std::exchange(had_rows_left, has_rows_left) && !has_rows_left && full_s == 0) {
          full_s = 1e-3 * static_cast<double>(clock.elapsed());
        }
      });
  constexpr int rests = 6, rest_ms = 2500;
  for (int n = 0; n < rests; ++n) {
    point_at(10, n % 2 == 0 ? 20 : -20);
    clock.start();
    full_s = 0;
    wait_ms(rest_ms);
    longest_s = std::max(longest_s, full_s > 0 ? full_s : 1e-3 * rest_ms);
  }
  std::printf("main_thread: coming to rest, the volume in full at most %.2f s after the pointer's last move:\n",
              longest_s);
  print_events(watch);
}

/// Whether something gray stands in the middle of a view on the screen. The light start page stands there before.
bool is_painted(const char* name) {
  if (!find<QPushButton>("palpateConnect").isEnabled()) return false;
  if (render_view(name).getRenderViewProxy()->GetRenderWindow()->GetNeverRendered() != 0) return false;
  // Something in the middle half: a volume may be clear in its middle, as lungs are.
  const QWidget& on = view(name);
  const QSize half = on.size() / 2;
  const QPoint corner = on.mapToGlobal(on.rect().center()) - QPoint(half.width() / 2, half.height() / 2);
  const QImage seen = QGuiApplication::primaryScreen()
                          ->grabWindow(0, corner.x(), corner.y(), half.width(), half.height())
                          .toImage()
                          .scaled(8, 8, Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
  for (int n = 0; n < 64; ++n) {
    if (qGray(seen.pixel(n % 8, n / 8)) > 16) return true;
  }
  return false;
}

/// Prints the stretches of 100 ms or more, each with its beginning.
void print_stretches(const BusyWatch& watch) {
  constexpr double long_ms = 100;
  for (const BusyWatch::Stretch& one : watch.stretches()) {
    if (one.took_ms < long_ms) continue;
    std::printf("first_image: busy from %.2f s on for %.0f ms (%.0f of a processor), %.0f of them rendering\n",
                1e-3 * one.began_ms, one.took_ms, one.processor_ms, one.rendering_ms);
  }
}

/// Not a test but a measurement: how long after a folder is dropped its scan is on the screen, and its tissues in the
/// panel; and how long the main thread is busy at a stretch until the views rest.
void first_image() {
  QElapsedTimer clock;
  clock.start();
  const BusyWatch watch;
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  wait_for("the scan is on the screen", [] { return is_painted("Axial"); });
  const double image_s = 1e-3 * static_cast<double>(clock.elapsed());
  wait_for("its tissues are found",
           [] { return !find<QWidget>("palpateStudying").isVisible() && widget("palpateOn0") != nullptr; });
  const double tissues_s = 1e-3 * static_cast<double>(clock.elapsed());
  wait_for("the volume is on the screen", [] { return is_painted("Volume"); });
  const double volume_s = 1e-3 * static_cast<double>(clock.elapsed());
  views_rest();
  save_screen("first-image");
  std::printf(
      "first_image: on the screen after %.2f s, tissues in the panel after %.2f s, and the volume by %.2f s; the main "
      "thread was busy for at most %.0f ms without rendering and %.0f ms with it\n",
      image_s, tissues_s, volume_s, watch.without_rendering().at(0), watch.longest_with_rendering_ms());
  print_stretches(watch);
}

double processor_s() {
  rusage used;
  getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& of) {
    return static_cast<double>(of.tv_sec) + 1e-6 * static_cast<double>(of.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Counts what is painted, by name: each repainted widget costs a picture of the whole window.
class Painted : public QObject {
 public:
  Painted() { qApp->installEventFilter(this); }
  ~Painted() override {
    for (const auto& [name, count] : counts_) {
      if (count > 1) std::printf("nothing_moves: painted %d times: %s\n", count, name.toUtf8().constData());
    }
  }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override {
    if (event->type() == QEvent::Paint) {
      ++counts_[watched->objectName() + QLatin1Char(' ') + QLatin1String(watched->metaObject()->className())];
    }
    return false;
  }

 private:
  std::map<QString, int> counts_;
};

/// Part of a core that the whole program takes, in percent, over some seconds in which nobody does anything.
double processor_at_rest() {
  constexpr int ms = 10'000;
  const double before = processor_s();
  const Painted painted;
  QEventLoop rest;  // polls nothing
  QTimer::singleShot(ms, &rest, &QEventLoop::quit);
  rest.exec();
  return 100 * (processor_s() - before) / (1e-3 * ms);
}

/// A measurement that is a test, too, with room for a busy machine: a scan is open and nothing moves.
void nothing_moves() {
  scan_is_shown();
  wait_for("its tissues are found", [] { return !find<QWidget>("palpateStudying").isVisible(); });
  for (int n = 0; n < 3; ++n) views_rest();
  const double open = processor_at_rest();
  click("palpateConnect");
  for (int n = 0; n < 3; ++n) views_rest();
  const double connected = processor_at_rest();
  click("palpateFeel");
  for (int n = 0; n < 3; ++n) views_rest();
  const double felt = processor_at_rest();
  std::printf(
      "nothing_moves: %.1f %% of a core with a scan open, %.1f %% with a stylus connected, %.1f %% with its force on\n",
      open, connected, felt);
  expect(open < 5 && connected < 10, "nothing is done over and over");
}

}  // namespace

const Scenarios& measured_scenarios() {
  static const Scenarios scenarios{
      {"main_thread", main_thread}, {"first_image", first_image}, {"nothing_moves", nothing_moves}};
  return scenarios;
}
