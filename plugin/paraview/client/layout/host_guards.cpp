#include "plugin/paraview/client/layout/host_guards.h"

#include <pqApplicationCore.h>
#include <pqDeleteReaction.h>
#include <pqLoadStateReaction.h>

#include <QAction>
#include <QEvent>
#include <QMainWindow>
#include <QTimer>

#include <utility>

namespace palpate::plugin {

HostGuards::HostGuards(QMainWindow& window, May may_end, May may_replace, QObject* parent)
    : QObject(parent), window_(window), may_end_(std::move(may_end)), may_replace_(std::move(may_replace)) {
  window_.installEventFilter(this);
  QTimer::singleShot(0, this, [this] { guard_actions(); });  // once ParaView's menus are there
}

void HostGuards::guard_actions() {
  auto* const core = pqApplicationCore::instance();
  if (auto* const exit = window_.findChild<QAction*>(QStringLiteral("actionFileExit"))) {
    guard(*exit, *core, may_end_, [core] { core->quit(); });
  }
  for (auto* const reaction : window_.findChildren<pqLoadStateReaction*>()) {
    guard(*reaction->parentAction(), *reaction, may_replace_, [] { pqLoadStateReaction::loadState(); });
  }
  for (auto* const reaction : window_.findChildren<pqDeleteReaction*>()) {
    if (reaction->parentAction()->objectName() != QLatin1String("actionDelete_All")) continue;  // one source alone
    guard(*reaction->parentAction(), *reaction, may_replace_, [] { pqDeleteReaction::deleteAll(); });
  }
}

/// ParaView's own is done after the question, and not beside it.
void HostGuards::guard(QAction& action, QObject& done_by, const May& may, const std::function<void()>& go_on) {
  if (!QObject::disconnect(&action, SIGNAL(triggered(bool)), &done_by, nullptr)) return;
  connect(&action, &QAction::triggered, this, [may, go_on] {
    if (may()) go_on();
  });
}

bool HostGuards::eventFilter(QObject* watched, QEvent* event) {
  if (watched != &window_ || event->type() != QEvent::Close || may_end_()) return QObject::eventFilter(watched, event);
  event->ignore();
  return true;
}

}  // namespace palpate::plugin
