#include "plugin/paraview/tests/panel/panel_rig.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>
#include <vtkBillboardTextActor3D.h>
#include <vtkCommand.h>
#include <vtkPVRenderView.h>
#include <vtkPropCollection.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkTextActor.h>

#include <QApplication>
#include <QCursor>
#include <QFile>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QPixmap>
#include <QPointer>
#include <QProcess>
#include <QRegularExpression>
#include <QScreen>
#include <QScrollArea>
#include <QTimer>
#include <QtTest/QTest>

#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <utility>

namespace {

int clicked = 0;

QWidget& main_window() {
  return *pqCoreUtilities::mainWidget();
}

/// The views are native windows, so they need the display's own pointer. Events are handled meanwhile: otherwise, on a
/// busy machine, the program would seem dead to the servo, which would remove the force.
void xdotool(const QStringList& arguments) {
  QProcess process;
  process.start(QStringLiteral("xdotool"), arguments);
  constexpr int longest = 120;  // s
  const bool ended = comes_true([&] { return process.state() == QProcess::NotRunning; }, longest);
  expect(ended && process.exitStatus() == QProcess::NormalExit && process.exitCode() == 0, "xdotool works");
  QTest::qWait(80);
}

}  // namespace

void scroll_to(QWidget& to) {
  for (QWidget* above = to.parentWidget(); above; above = above->parentWidget()) {
    if (auto* const scroll = qobject_cast<QScrollArea*>(above)) scroll->ensureWidgetVisible(&to);
  }
  QTest::qWait(30);
}

void scroll_to(QWidget& to, const QWidget& shown) {
  is_laid_out(to);
  scroll_to(to);
  is_laid_out(shown);
}

void save_screen(const std::string& name) {
  const QString folder = qEnvironmentVariable("PALPATE_PICTURES");
  if (folder.isEmpty()) return;
  QGuiApplication::primaryScreen()->grabWindow(0).save(folder + QStringLiteral("/panel-") +
                                                       QString::fromStdString(name) + QStringLiteral(".png"));
}

QWidget* widget(const char* name) {
  for (QWidget* const top : QApplication::topLevelWidgets()) {
    if (top->objectName() == QLatin1String(name)) return top;
    if (auto* const found = top->findChild<QWidget*>(QString::fromLatin1(name))) return found;
  }
  return nullptr;
}

QString label(const char* name) {
  return find<QLabel>(name).text();
}

double number(const char* name) {
  const auto match = QRegularExpression(QStringLiteral("^(?:Volume )?(-?[0-9.]+)")).match(label(name));
  return match.hasMatch() ? match.captured(1).toDouble() : 0;
}

int clicks() {
  return clicked;
}

void click(QWidget& on, const QPoint& at) {
  ++clicked;
  QTest::mouseClick(&on, Qt::LeftButton, {}, at);
}

void click(const char* name) {
  QWidget& on = find<QWidget>(name);
  scroll_to(on);
  expect(on.isVisible() && on.isEnabled(), std::string(name) + " can be clicked");
  click(on, on.rect().center());
}

void press_key(int key) {
  QWidget* const focus =
      QApplication::activeModalWidget() ? QApplication::activeModalWidget() : QApplication::focusWidget();
  QTest::keyClick(focus ? focus : &main_window(), static_cast<Qt::Key>(key));
}

void type_key(const char* key) {
  xdotool({QStringLiteral("key"), QString::fromLatin1(key)});
}

void in_dialog(const char* button, const std::function<void(QDialog&)>& act) {
  in_dialog_of(
      button, [button] { click(button); }, act);
}

void in_dialog_of(const std::string& what, const std::function<void()>& open,
                  const std::function<void(QDialog&)>& act) {
  bool came = false;
  std::exception_ptr failed;
  QTimer looking;
  QObject::connect(&looking, &QTimer::timeout, [&] {
    auto* const dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
    if (!dialog || !dialog->isVisible()) return;
    looking.stop();
    came = true;
    try {
      handle_events(20);
      act(*dialog);
    } catch (...) {
      failed = std::current_exception();
      dialog->reject();
    }
  });
  constexpr int poll_ms = 200;
  looking.start(poll_ms);
  open();
  for (int ms = 0; !came && ms < 2000; ms += 20) handle_events(20);  // one that does not keep its caller waiting
  if (failed) std::rethrow_exception(failed);
  expect(came, what + " opens a dialog");
}

void name_file(const char* button, const QString& file) {
  in_dialog(button, [&](QDialog& dialog) {
    auto* const name = dialog.findChild<QLineEdit*>(QStringLiteral("fileNameEdit"));
    expect(name != nullptr, std::string(button) + " asks for a file");
    name->setText(file);
    QMetaObject::invokeMethod(&dialog, "accept");
  });
}

void save_as(const char* button, const QString& file) {
  QFile::remove(file);
  name_file(button, file);
  expect(QFile::exists(file), file.toStdString() + " is written");
}

pqRenderView& render_view(const char* name) {
  for (pqRenderView* const one : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>()) {
    if (one->getSMName() == QLatin1String(name)) return *one;
  }
  throw std::runtime_error(std::string("there is no view ") + name);
}

QWidget& view(const char* name) {
  return *render_view(name).widget();
}

namespace {

/// Of the texts over a slice: four letters, the corner, the pointer, who was scanned, the place.
QString overlay_text(const char* name, int which) {
  auto* const client = vtkPVRenderView::SafeDownCast(render_view(name).getRenderViewProxy()->GetClientSideView());
  vtkPropCollection& props = *client->GetNonCompositedRenderer()->GetViewProps();
  int at = 0;
  for (int n = 0; n < props.GetNumberOfItems(); ++n) {
    auto* const text = vtkTextActor::SafeDownCast(props.GetItemAsObject(n));
    if (text && at++ == which)
      return text->GetInput() && text->GetVisibility() ? QString::fromUtf8(text->GetInput()) : QString();
  }
  throw std::runtime_error(std::string("there are no texts over ") + name);
}

}  // namespace

QString corner_text(const char* view) {
  return overlay_text(view, 4);
}

QString pointer_text(const char* view) {
  return overlay_text(view, 5);
}

QString identity_text(const char* view) {
  return overlay_text(view, 6);
}

QString place_text(const char* view) {
  return overlay_text(view, 7);
}

QStringList measured_in(const char* view) {
  QStringList texts;
  vtkRendererCollection& layers = *render_view(view).getRenderViewProxy()->GetRenderWindow()->GetRenderers();
  for (int layer = 0; layer < layers.GetNumberOfItems(); ++layer) {
    vtkPropCollection& props = *vtkRenderer::SafeDownCast(layers.GetItemAsObject(layer))->GetViewProps();
    for (int n = 0; n < props.GetNumberOfItems(); ++n) {
      auto* const text = vtkBillboardTextActor3D::SafeDownCast(props.GetItemAsObject(n));
      if (text && text->GetVisibility() && text->GetInput()) texts << QString::fromUtf8(text->GetInput());
    }
  }
  return texts;
}

void turn_wheel(const char* name, int steps) {
  vtkRenderWindowInteractor& interactor = *render_view(name).getRenderViewProxy()->GetInteractor();
  const QSize size = render_view(name).widget()->size();
  interactor.SetEventInformation(size.width() / 2, size.height() / 2);
  interactor.InvokeEvent(vtkCommand::MouseMoveEvent);
  for (int n = 0; n < std::abs(steps); ++n) {
    interactor.InvokeEvent(steps > 0 ? vtkCommand::MouseWheelForwardEvent : vtkCommand::MouseWheelBackwardEvent);
  }
  handle_events(20);
}

void point_with_shift(const char* name, double x, double y) {
  vtkRenderWindowInteractor& interactor = *render_view(name).getRenderViewProxy()->GetInteractor();
  const QSize size = render_view(name).widget()->size();
  interactor.SetEventInformation(static_cast<int>(x * size.width()), static_cast<int>(y * size.height()), 0, 1);
  interactor.InvokeEvent(vtkCommand::MouseMoveEvent);
  interactor.SetShiftKey(0);
  handle_events(20);
}

void move_pointer(const QWidget& in, const QPoint& at) {
  const QPoint place = in.mapToGlobal(at);
  xdotool({QStringLiteral("mousemove"), QString::number(place.x()), QString::number(place.y())});
  // When the display has moved the pointer, the events of its path arrive next.
  const QRect screen = QGuiApplication::primaryScreen()->geometry();
  if (screen.contains(place)) {
    wait_for(
        "the pointer is there", [&] { return QCursor::pos() == place; }, 20);
  }
  handle_events(3);
}

void drag(QWidget& view, const QPoint& from, const QPoint& to, bool release) {
  ++clicked;
  move_pointer(view, from);
  xdotool({QStringLiteral("mousedown"), QStringLiteral("1")});
  constexpr int steps = 12;
  for (int n = 1; n <= steps; ++n) move_pointer(view, from + (to - from) * n / steps);
  if (release) let_go();
}

void let_go() {
  xdotool({QStringLiteral("mouseup"), QStringLiteral("1")});
}

void double_click(QWidget& view, const QPoint& at) {
  move_pointer(view, at);
  xdotool({QStringLiteral("click"), QStringLiteral("--repeat"), QStringLiteral("2"), QStringLiteral("--delay"),
           QStringLiteral("60"), QStringLiteral("1")});
}

namespace {

/// By the display: the pointer is in the view, and has clicked beside everything.
void key_in(QWidget& view, const char* how, const char* key) {
  static QPointer<QWidget> last;
  if (last != &view) {
    last = &view;
    constexpr QPoint corner(12, 12);
    move_pointer(view, corner);
    xdotool({QStringLiteral("click"), QStringLiteral("1")});
  }
  xdotool({QString::fromLatin1(how), QString::fromLatin1(key)});
}

}  // namespace

void press_key_in(QWidget& view, const char* key) {
  key_in(view, "key", key);
}

void hold_key_in(QWidget& view, const char* key, bool down) {
  key_in(view, down ? "keydown" : "keyup", key);
}
