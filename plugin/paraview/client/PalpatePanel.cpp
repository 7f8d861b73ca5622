#include "plugin/paraview/client/PalpatePanel.h"

#include <pqActiveObjects.h>
#include <pqCoreUtilities.h>
#include <pqQVTKWidget.h>
#include <pqView.h>

#include <QAbstractButton>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QComboBox>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QKeyEvent>
#include <QMainWindow>
#include <QMimeData>
#include <QTimer>
#include <QUrl>

#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/language/translation.h"
#include "plugin/paraview/client/scan/scan_section.h"

namespace {

void focus_marked_view() {
  if (QApplication::activeModalWidget() || QApplication::activePopupWidget()) return;
  pqView* const marked = pqActiveObjects::instance().activeView();
  if (!marked) return;
  auto* const frame = qobject_cast<pqQVTKWidget*>(marked->widget());
  QWidget* const picture = frame ? frame->renderWidget() : marked->widget();
  // The view may be a native window in a container that forwards the keys.
  for (QWidget* const child : picture->findChildren<QWidget*>()) {
    if (!child->inherits("QWindowContainer")) continue;
    child->setFocus();
    return;
  }
  picture->setFocus();
}

/// Whether keys go to a view: not to a text, a list or a dialog.
bool has_view_keys() {
  if (QApplication::activeModalWidget() || QApplication::activePopupWidget()) return false;
  for (const QWidget* at = QApplication::focusWidget(); at; at = at->parentWidget()) {
    if (qobject_cast<const pqQVTKWidget*>(at)) return true;
  }
  return false;
}

}  // namespace

PalpatePanel::PalpatePanel(QWidget* parent)
    : QDockWidget(parent),
      translation_(std::make_unique<palpate::plugin::Translation>()),
      parts_(std::make_unique<palpate::plugin::PanelParts>(
          *this, *qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget()))) {
  setWindowTitle(tr("Palpate"));
  setObjectName(QStringLiteral("PalpatePanel"));
  setAcceptDrops(true);
  parts_->build();
  QCoreApplication::instance()->installEventFilter(this);
}

PalpatePanel::~PalpatePanel() {
  delete widget();  // the sections lean on the parts
}

/// A folder may be dropped anywhere on the panel.
void PalpatePanel::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls() && event->mimeData()->urls().first().isLocalFile()) event->acceptProposedAction();
}

void PalpatePanel::dropEvent(QDropEvent* event) {
  parts_->column->scan->open_later(event->mimeData()->urls().first().toLocalFile());
}

/// M in a view is the mark button. It is let go wherever the keyboard has gone meanwhile.
void PalpatePanel::mark_by_key(const QKeyEvent& event) {
  if (event.key() != Qt::Key_M || event.isAutoRepeat()) return;
  if (event.type() == QEvent::KeyRelease) parts_->session.let_go_mark();
  if (event.type() == QEvent::KeyPress && event.modifiers() == Qt::NoModifier && has_view_keys()) {
    parts_->session.press_mark();
  }
}

/// While an outline is corrected, holding B in a view shows the earlier outline, and F frees the stylus from its slice.
/// Returns whether the key is used: ParaView would otherwise select blocks, or move the camera.
bool PalpatePanel::correct_by_key(const QKeyEvent& event) {
  palpate::plugin::CorrectionModel& correction = parts_->correction;
  const bool before = event.key() == Qt::Key_B, frees = event.key() == Qt::Key_F && correction.held_in();
  if ((!before && !frees) || !correction.structure()) return false;
  const bool let_go = event.type() == QEvent::KeyRelease;  // whatever else is held by then
  if (!let_go && event.modifiers() != Qt::NoModifier) return false;
  const bool pressed = !let_go && has_view_keys();
  if (!pressed && !(before ? correction.shows_before() : correction.is_freed())) return false;
  if (!event.isAutoRepeat()) before ? correction.show_before(pressed) : correction.set_freed(pressed);
  return true;
}

/// Another program has the keyboard: no key that is let go there comes here.
void PalpatePanel::let_go_keys() {
  parts_->session.let_go_mark();
  parts_->correction.show_before(false);
  parts_->correction.set_freed(false);
}

bool PalpatePanel::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::ApplicationDeactivate) let_go_keys();
  const bool pressed = event->type() == QEvent::KeyPress || event->type() == QEvent::ShortcutOverride;
  if (pressed && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape) parts_->session.release();
  if (event->type() == QEvent::KeyPress || event->type() == QEvent::KeyRelease) {
    mark_by_key(*static_cast<QKeyEvent*>(event));
  }
  if ((pressed || event->type() == QEvent::KeyRelease) && correct_by_key(*static_cast<QKeyEvent*>(event))) {
    return true;
  }
  // A button that was clicked is done with: the arrow keys are the marked view's again.
  if (event->type() == QEvent::MouseButtonRelease && qobject_cast<QAbstractButton*>(watched) &&
      isAncestorOf(static_cast<QWidget*>(watched))) {
    QTimer::singleShot(0, this, [] { focus_marked_view(); });
  }
  // A number changes only where it was clicked: focus that a hidden button leaves behind is not to come to it.
  if (event->type() == QEvent::Polish && isAncestorOf(qobject_cast<QWidget*>(watched)) &&
      (qobject_cast<QAbstractSpinBox*>(watched) || qobject_cast<QComboBox*>(watched) ||
       qobject_cast<QAbstractSlider*>(watched))) {
    static_cast<QWidget*>(watched)->setFocusPolicy(Qt::ClickFocus);
  }
  // The wheel scrolls the column: a force limit that the pointer happens to pass over is not to change.
  if (event->type() == QEvent::Wheel && isAncestorOf(qobject_cast<QWidget*>(watched)) &&
      (qobject_cast<QAbstractSpinBox*>(watched) || qobject_cast<QComboBox*>(watched)) &&
      !static_cast<QWidget*>(watched)->hasFocus()) {
    event->ignore();
    return true;
  }
  return QDockWidget::eventFilter(watched, event);  // Esc means what it always does, too
}
