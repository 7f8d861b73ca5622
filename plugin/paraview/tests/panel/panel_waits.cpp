// Waiting like a user of the panel, and finding the stylus on the screen.

#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>

#include <QElapsedTimer>
#include <QGuiApplication>
#include <QImage>
#include <QPixmap>
#include <QScreen>
#include <QtTest/QTest>

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "solver/text/testing/crowd.h"

void expect(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error("it does not hold that " + what);
}

void wait_for(const std::string& what, const std::function<bool()>& holds, int seconds) {
  if (!comes_true(holds, seconds)) {
    throw std::runtime_error("after " + std::to_string(seconds) + " s still not: " + what);
  }
}

void wait_ms(int ms) {
  QTest::qWait(ms);
}

bool comes_true(const std::function<bool()>& holds, int seconds) {
  QElapsedTimer waited;
  for (waited.start(); !QTest::qWaitFor(holds, 500);) {
    if (static_cast<double>(waited.elapsed()) > 1000 * seconds * palpate::crowd()) return false;
  }
  return true;
}

void handle_events(int times) {
  int handled = 0;
  wait_for("events are handled", [&] { return handled++ == times; });
}

// What stays is counted in turns of the event loop and not in time: while the program is busy nothing changes.
QString steady(const std::string& what, const std::function<QString()>& text, int turns) {
  QString last = text();
  int same = 0;
  wait_for(what + " stays", [&] {
    const QString now = text();
    same = std::exchange(last, now) == now ? same + 1 : 0;
    return same == turns;
  });
  return last;
}

void is_laid_out(const QWidget& shown) {
  constexpr int turns = 30;
  const auto place = [&] {
    const QPoint at = shown.mapToGlobal(QPoint(0, 0));
    return QStringLiteral("%1 %2 %3 %4").arg(at.x()).arg(at.y()).arg(shown.width()).arg(shown.height());
  };
  const std::string name = shown.objectName().toStdString();
  wait_for(
      name + " is seen", [&] { return shown.isVisible(); }, 20);
  steady("the place of " + name, place, turns);
}

double steady_number(const char* name) {
  double first = number(name);
  int same = 0;
  wait_for(std::string(name) + " stays", [&] {
    constexpr double part = 0.005;
    const double now = number(name);
    const bool stays = std::abs(now - first) <= part * std::abs(first);
    same = stays ? same + 1 : 0;
    if (!stays) first = now;
    return same == 100;
  });
  return first;
}

namespace {

/// The picture of a view on the screen.
QImage picture_of(QWidget& view) {
  QWidget& window = *pqCoreUtilities::mainWidget();
  const QPoint at = view.mapTo(&window, QPoint(0, 0));
  return QGuiApplication::primaryScreen()
      ->grabWindow(window.winId(), at.x(), at.y(), view.width(), view.height())
      .toImage();
}

bool is_yellow(QRgb color) {
  return qRed(color) > 120 && qGreen(color) > 0.7 * qRed(color) && qBlue(color) < 0.45 * qRed(color);
}

/// In each pixel, how many yellow ones are above it and to its left.
std::vector<std::vector<int>> yellow_before(const QImage& seen) {
  const QImage picture = seen.convertToFormat(QImage::Format_RGB32);
  const auto rows = static_cast<std::size_t>(picture.height()), columns = static_cast<std::size_t>(picture.width());
  std::vector<std::vector<int>> sums(rows + 1, std::vector<int>(columns + 1));
  for (std::size_t y = 0; y < rows; ++y) {
    const auto* const row = reinterpret_cast<const QRgb*>(picture.constScanLine(static_cast<int>(y)));
    int in_row = 0;
    for (std::size_t x = 0; x < columns; ++x) {
      in_row += is_yellow(row[x]) ? 1 : 0;
      sums[y + 1][x + 1] = sums[y][x + 1] + in_row;
    }
  }
  return sums;
}

}  // namespace

void views_rest() {
  std::vector<QImage> last;
  int same = 0, turn = 0;
  constexpr int turns = 150, between = 5;
  (void)comes_true([&] {
    ++same;
    if (++turn % between != 0) return false;
    std::vector<QImage> now;
    for (pqRenderView* const one : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>()) {
      if (one->widget() && one->widget()->isVisible()) now.push_back(picture_of(*one->widget()));
    }
    if (std::exchange(last, now) != now) same = 0;
    return same >= turns;
  });
}

std::optional<QPoint> proxy_now(QWidget& view) {
  const QImage picture = picture_of(view);
  const auto before = yellow_before(picture);
  // The largest patch of its yellow: letters are of another, and thin.
  std::optional<QPoint> best;
  constexpr int half = 5, enough = 60;
  int most = enough - 1;
  for (int y = half; y < picture.height() - half; y += 2) {
    for (int x = half; x < picture.width() - half; x += 2) {
      const auto top = static_cast<std::size_t>(y - half), left = static_cast<std::size_t>(x - half);
      constexpr std::size_t side = 2 * half + 1;
      const int yellow =
          before[top + side][left + side] - before[top][left + side] - before[top + side][left] + before[top][left];
      if (yellow <= most) continue;
      most = yellow;
      best = {x, y};
    }
  }
  return best;
}

QPoint proxy_in(QWidget& view) {
  std::optional<QPoint> last;
  int same = 0;
  wait_for(
      "the proxy is seen in the view, and stays there",
      [&] {
        const auto now = proxy_now(view);
        same = now && std::exchange(last, now) == now ? same + 1 : 0;
        return same == 50;
      },
      30);
  return *last;
}
