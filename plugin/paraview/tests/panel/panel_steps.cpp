#include "plugin/paraview/tests/panel/panel_steps.h"

#include <pqApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>
#include <vtkCommand.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMRenderViewProxy.h>

#include <QCoreApplication>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QMimeData>
#include <QPushButton>
#include <QUrl>

#include <stdexcept>

#include "plugin/paraview/tests/panel/panel_rig.h"

std::string scene_text() {
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source->getProxy()->GetXMLName() == std::string("PalpateScene")) {
      return vtkSMPropertyHelper(source->getProxy(), "Scene").GetAsString();
    }
  }
  return {};
}

void scan_is_shown() {
  wait_for("the scan is in the views", [] { return find<QPushButton>("palpateConnect").isEnabled(); });
  wait_for("its tissues are found", [] { return !find<QWidget>("palpateStudying").isVisible(); });
  wait_ms(1500);
}

bool forces_are_on() {
  return label("palpateState").startsWith("Feeling: forces are on");
}

void turn_forces_on() {
  auto& feel = find<QPushButton>("palpateFeel");
  wait_for("it is known what the stylus does", [] { return !label("palpateState").isEmpty(); });
  wait_for("forces are on", [&] {
    if (feel.isEnabled() && !label("palpateState").startsWith("Feeling")) {
      click("palpateFeel");  // or "Clear fault" before it
      wait_ms(100);
    }
    return forces_are_on();
  });
}

void connect_stylus() {
  click("palpateConnect");
  turn_forces_on();
  wait_ms(1500);
}

namespace {

vtkRenderWindowInteractor& interactor(const char* name) {
  for (pqRenderView* const one : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>()) {
    if (one->getSMName() == QLatin1String(name)) return *one->getRenderViewProxy()->GetInteractor();
  }
  throw std::runtime_error(std::string("there is no view ") + name);
}

}  // namespace

void press() {
  QWidget& sagittal = view("Sagittal");
  constexpr int tries = 3;
  for (int n = 0; n < tries; ++n) {
    QPoint from = proxy_in(sagittal);
    if (n > 0) {  // a busy machine's servo had taken the force away, and the hand went through: to the front again
      drag(sagittal, from, QPoint(20, from.y()), true);
      wait_ms(2000);
      turn_forces_on();
      from = proxy_in(sagittal);
    }
    drag(sagittal, from, from + QPoint(4, 0), false);  // the front is on the left
    for (int pixels = 8; pixels < 120 && number("palpateForce") < 0.3; pixels += 4) {
      move_pointer(sagittal, from + QPoint(pixels, 0));
    }
    for (int waits = 0; waits < 50 && number("palpateForce") <= 0.2; ++waits) wait_ms(100);
    if (number("palpateForce") > 0.2) {
      wait_ms(500);
      return;
    }
    let_go();
  }
  throw std::runtime_error("a force is felt: not in " + std::to_string(tries) + " presses");
}

void press_once() {
  vtkRenderWindowInteractor& hand = interactor("Sagittal");
  const auto send = [&](unsigned long event, const QPoint& at) {
    hand.SetEventInformation(at.x(), view("Sagittal").height() - 1 - at.y());
    hand.InvokeEvent(event);
    wait_ms(40);
  };
  constexpr int tries = 5;
  for (int n = 0; n < tries; ++n) {
    turn_forces_on();
    QPoint at = proxy_in(view("Sagittal"));
    send(vtkCommand::LeftButtonPressEvent, at);
    if (n > 0) {  // it went through when the force was taken away
      at.setX(20);
      send(vtkCommand::MouseMoveEvent, at);
      wait_ms(2000);
    }
    for (int pixels = 0; pixels < 160 && number("palpateForce") < 0.3; pixels += 2) {
      send(vtkCommand::MouseMoveEvent, at + QPoint(pixels, 0));
    }
    const bool felt = number("palpateForce") > 0.2;
    wait_ms(300);
    send(vtkCommand::LeftButtonReleaseEvent, at);
    if (felt) return;
  }
  throw std::runtime_error("nothing is felt, however often one presses");
}

void feel() {
  scan_is_shown();
  connect_stylus();
  press();
}

void drop_folder(const QString& folder) {
  QWidget& on = find<QWidget>("palpateScan");
  QMimeData folders;
  folders.setUrls({QUrl::fromLocalFile(folder)});
  QDragEnterEvent enter(on.rect().center(), Qt::CopyAction, &folders, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(&on, &enter);
  expect(enter.isAccepted(), "a folder may be dropped");
  QDropEvent drop(on.rect().center(), Qt::CopyAction, &folders, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(&on, &drop);
}
