#include "plugin/paraview/client/layout/seen_panels.h"

#include <pqActiveObjects.h>
#include <pqColorMapEditor.h>
#include <pqDataRepresentation.h>
#include <pqPropertiesPanel.h>
#include <pqView.h>

#include <QCoreApplication>
#include <QEvent>
#include <QMainWindow>
#include <QObject>

namespace palpate::plugin {
namespace {

void follow(pqPropertiesPanel& panel) {
  pqActiveObjects& active = pqActiveObjects::instance();
  QObject::connect(&active, &pqActiveObjects::viewChanged, &panel, &pqPropertiesPanel::setView);
  QObject::connect(&active, &pqActiveObjects::pipelineProxyChanged, &panel, &pqPropertiesPanel::setPipelineProxy);
  QObject::connect(&active, QOverload<pqDataRepresentation*>::of(&pqActiveObjects::representationChanged), &panel,
                   &pqPropertiesPanel::setRepresentation);
  panel.setView(active.activeView());
  panel.setPipelineProxy(active.activePipelineProxy());
  panel.setRepresentation(active.activeRepresentation());
}

/// The object may be deleted before the panel is visible again, and would be kept alive until then.
void let_go(pqPropertiesPanel& panel) {
  panel.setRepresentation(nullptr);
  panel.setPipelineProxy(nullptr);
  panel.setView(nullptr);
}

void follow(pqColorMapEditor& panel) {
  // A protected slot: by its name.
  QObject::connect(&pqActiveObjects::instance(), SIGNAL(representationChanged(pqDataRepresentation*)), &panel,
                   SLOT(updateActive()));
  QMetaObject::invokeMethod(&panel, "updateActive");
}

/// It only holds a weak reference.
void let_go(pqColorMapEditor& /*panel*/) {}

/// Not the dock's visibilityChanged: it is false if the dock is shown before it is laid out.
template <typename Panel>
class WhileSeen : public QObject {
 public:
  explicit WhileSeen(Panel& panel) : QObject(&panel), panel_(panel) {
    if (!panel.isVisible()) unfollow();
    panel.installEventFilter(this);
    connect(QCoreApplication::instance(), &QCoreApplication::aboutToQuit, this,
            [this] { panel_.removeEventFilter(this); });
  }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override {
    const bool seen = event->type() == QEvent::Show, hidden = event->type() == QEvent::Hide;
    if ((seen || hidden) && !event->spontaneous()) {
      unfollow();
      seen ? follow(panel_) : let_go(panel_);
    }
    return QObject::eventFilter(watched, event);
  }

 private:
  void unfollow() { disconnect(&pqActiveObjects::instance(), nullptr, &panel_, nullptr); }

  Panel& panel_;
};

}  // namespace

void follow_while_seen(QMainWindow& window) {
  for (auto* const panel : window.findChildren<pqPropertiesPanel*>()) new WhileSeen(*panel);
  for (auto* const panel : window.findChildren<pqColorMapEditor*>()) new WhileSeen(*panel);
}

}  // namespace palpate::plugin
