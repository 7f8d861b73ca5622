#include "plugin/paraview/client/layout/host_guards.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqDeleteReaction.h>
#include <pqLoadStateReaction.h>
#include <pqRecentFilesMenu.h>
#include <pqServer.h>

#include <QAction>
#include <QDropEvent>
#include <QEvent>
#include <QMainWindow>
#include <QMenu>
#include <QMimeData>
#include <QTimer>
#include <QUrl>

#include <algorithm>
#include <utility>

namespace palpate::plugin {
namespace {

// Since 5.12 ParaView also finds states in the pictures that it saves. Whether this one holds a state it asks
// afterwards.
bool names_state(const QString& file) {
  return file.contains(QLatin1String(".pvsm"), Qt::CaseInsensitive) ||
         file.contains(QLatin1String(".png"), Qt::CaseInsensitive);
}

bool brings_state(const QDropEvent& dropped) {
  const QList<QUrl> urls = dropped.mimeData()->urls();
  return std::any_of(urls.begin(), urls.end(), [](const QUrl& url) { return names_state(url.fileName()); });
}

}  // namespace

HostGuards::HostGuards(QMainWindow& window, May may_end, May may_replace, std::function<void()> still_here,
                       QObject* parent)
    : QObject(parent),
      window_(window),
      may_end_(std::move(may_end)),
      may_replace_(std::move(may_replace)),
      still_here_(std::move(still_here)) {
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
  for (auto* const recent : window_.findChildren<pqRecentFilesMenu*>()) guard_recent(*recent);
}

/// The same for the menu of recent files, which also lists data: that takes nothing away.
void HostGuards::guard_recent(pqRecentFilesMenu& recent) {
  for (auto* const menu : window_.findChildren<QMenu*>()) {
    if (!QObject::disconnect(menu, SIGNAL(triggered(QAction*)), &recent, SLOT(onOpenResource(QAction*)))) continue;
    connect(menu, &QMenu::triggered, &recent, [this, &recent](QAction* chosen) {
      const bool is_state = names_state(chosen->text()) || names_state(chosen->data().toString());
      if (is_state && !may_replace_()) return;
      const QPointer<pqServer> before = pqActiveObjects::instance().activeServer();
      QMetaObject::invokeMethod(&recent, "onOpenResource", Q_ARG(QAction*, chosen));
      look_afterwards(before);
    });
  }
}

/// ParaView's own is done after the question, and not beside it.
void HostGuards::guard(QAction& action, QObject& done_by, const May& may, const std::function<void()>& go_on) {
  if (!QObject::disconnect(&action, SIGNAL(triggered(bool)), &done_by, nullptr)) return;
  connect(&action, &QAction::triggered, this, [this, may, go_on] {
    if (!may()) return;
    const QPointer<pqServer> before = pqActiveObjects::instance().activeServer();
    go_on();
    look_afterwards(before);
  });
}

/// In the next turn of the event loop: the program may be about to end.
void HostGuards::look_afterwards(const QPointer<pqServer>& before) {
  QTimer::singleShot(0, this, [this, before] {
    if (before && before == pqActiveObjects::instance().activeServer()) still_here_();
  });
}

bool HostGuards::eventFilter(QObject* watched, QEvent* event) {
  if (watched != &window_) return QObject::eventFilter(watched, event);
  const bool closes = event->type() == QEvent::Close;
  const bool loads = event->type() == QEvent::Drop && brings_state(*static_cast<QDropEvent*>(event));
  if (!closes && !loads) return QObject::eventFilter(watched, event);
  if (closes ? may_end_() : may_replace_()) {
    look_afterwards(pqActiveObjects::instance().activeServer());
    return QObject::eventFilter(watched, event);
  }
  event->ignore();
  return true;
}

}  // namespace palpate::plugin
