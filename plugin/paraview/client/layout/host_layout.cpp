#include "plugin/paraview/client/layout/host_layout.h"

#include <pqApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <pqTabbedMultiViewWidget.h>

#include <QAction>
#include <QCoreApplication>
#include <QDockWidget>
#include <QKeySequence>
#include <QMainWindow>
#include <QSettings>
#include <QStatusBar>
#include <QTabWidget>
#include <QTimer>
#include <QToolBar>

#include "plugin/paraview/client/layout/seen_panels.h"

namespace palpate::plugin {
namespace {

QString remembered() {
  return QStringLiteral("palpate/advanced");
}

bool has_pipeline() {
  return !pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>().isEmpty();
}

}  // namespace

HostLayout::HostLayout(QMainWindow& window, QToolBar& toolbar, QDockWidget& panel, QObject* parent)
    : QObject(parent), window_(window), toolbar_(toolbar), panel_(panel) {
  follow_while_seen(window_);
  // ParaView restores its window from the last time, 10 ms after it is made.
  auto* const waiting = new QTimer(this);
  connect(waiting, &QTimer::timeout, this, [this, waiting] {
    if (!window_.isVisible()) return;
    waiting->deleteLater();
    begin();
  });
  constexpr int poll_ms = 50;
  waiting->start(poll_ms);
  // ParaView remembers how its window looks: that is to be as it was without us.
  connect(QCoreApplication::instance(), &QCoreApplication::aboutToQuit, this, [this] {
    for (const auto& widget : hidden_) {
      if (widget) widget->setVisible(true);
    }
  });
}

/// Later it is where the user has moved it.
void HostLayout::place_first() {
  const QString placed = QStringLiteral("palpate/placed");
  if (QSettings().value(placed).toBool()) return;
  QSettings().setValue(placed, true);
  // After the window is laid out without the hidden panels.
  constexpr int panel_width = 360, laid_out_ms = 300;
  QTimer::singleShot(laid_out_ms, this, [this] { window_.resizeDocks({&panel_}, {panel_width}, Qt::Horizontal); });
  // Above ParaView's, in a row of its own.
  for (QToolBar* const bar : window_.findChildren<QToolBar*>(QString(), Qt::FindDirectChildrenOnly)) {
    if (bar == &toolbar_ || window_.toolBarArea(bar) != Qt::TopToolBarArea || bar->y() > toolbar_.y()) continue;
    window_.insertToolBar(bar, &toolbar_);
    window_.insertToolBarBreak(bar);
    return;
  }
}

/// ParaView's Ctrl+S exports the values of the scan; a user means to save the state.
void HostLayout::let_key_save_state() {
  auto* const data = window_.findChild<QAction*>(QStringLiteral("actionFileSaveData"));
  auto* const state = window_.findChild<QAction*>(QStringLiteral("actionFileSaveServerState"));
  if (!data || !state) return;
  data->setShortcut({});
  state->setShortcut(QKeySequence::Save);
}

void HostLayout::begin() {
  place_first();
  let_key_save_state();
  if (has_pipeline() || QSettings().value(remembered(), false).toBool()) {
    emit advanced_changed(true);
    return;
  }
  advanced_ = false;
  hide_host();
  emit advanced_changed(false);
}

void HostLayout::set_advanced(bool advanced) {
  if (advanced == advanced_) return;
  advanced_ = advanced;
  QSettings().setValue(remembered(), advanced);
  advanced ? show_host() : hide_host();
  emit advanced_changed(advanced);
}

void HostLayout::hide_host() {
  const auto hide = [this](QWidget* widget) {
    if (!widget || widget == &toolbar_ || widget == &panel_ || widget->isHidden()) return;
    widget->hide();
    hidden_ << widget;
  };
  for (QToolBar* const bar : window_.findChildren<QToolBar*>(QString(), Qt::FindDirectChildrenOnly)) hide(bar);
  for (QDockWidget* const dock : window_.findChildren<QDockWidget*>(QString(), Qt::FindDirectChildrenOnly)) hide(dock);
  hide(window_.findChild<QStatusBar*>(QString(), Qt::FindDirectChildrenOnly));
  refresh_tabs();
}

void HostLayout::show_host() {
  for (const auto& widget : hidden_) {
    if (widget) widget->show();
  }
  hidden_.clear();
  // Otherwise the last shown tab would be in front: Information, which tells little.
  auto* const properties =
      window_.findChild<QDockWidget*>(QStringLiteral("propertiesDock"), Qt::FindDirectChildrenOnly);
  if (properties && properties->isVisibleTo(&window_)) properties->raise();
  refresh_tabs();
}

void HostLayout::refresh_tabs() {
  auto* const views = window_.findChild<pqTabbedMultiViewWidget*>();
  if (!views) return;
  views->setDecorationsVisibility(advanced_);
  const auto* const tabs = views->findChild<QTabWidget*>();
  constexpr int one_and_the_plus = 2;
  views->setTabVisibility(advanced_ || (tabs && tabs->count() > one_and_the_plus));
}

}  // namespace palpate::plugin
