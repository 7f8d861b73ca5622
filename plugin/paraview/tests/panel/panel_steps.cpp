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
#include <QListWidget>
#include <QMimeData>
#include <QPushButton>
#include <QUrl>

#include <stdexcept>

#include "plugin/paraview/tests/panel/panel_rig.h"

namespace {

std::string text_beside_the_scene(const char* property) {
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source->getProxy()->GetXMLName() == std::string("PalpateScene")) {
      return vtkSMPropertyHelper(source->getProxy(), property).GetAsString();
    }
  }
  return {};
}

/// The first scan of the pipeline; nullptr where there is none.
pqPipelineSource* found_reader() {
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source->getProxy()->GetXMLName() == std::string("PalpateDicomReader")) return source;
  }
  return nullptr;
}

}  // namespace

pqPipelineSource& reader() {
  if (pqPipelineSource* const found = found_reader()) return *found;
  throw std::runtime_error("there is no scan in the pipeline");
}

unsigned reader_in_pipeline() {
  pqPipelineSource* const found = found_reader();
  return found ? found->getProxy()->GetGlobalID() : 0;
}

void choose_series(int row) {
  const unsigned before = reader_in_pipeline();
  auto& series = find<QListWidget>("palpateSeries");
  wait_for("the series are listed", [&] { return series.count() > row; });
  scroll_to(series);
  series.scrollToItem(series.item(row));
  click(*series.viewport(), series.visualItemRect(series.item(row)).center());
  wait_for("another scan is in the pipeline",
           [&] { return reader_in_pipeline() != 0 && reader_in_pipeline() != before; });
  scan_is_shown();
}

std::string scene_text() {
  return text_beside_the_scene("Scene");
}

std::string marks_text() {
  return text_beside_the_scene("Marks");
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
  const QPoint from = proxy_in(sagittal);
  drag(sagittal, from, from + QPoint(4, 0), false);  // the front is on the left
  for (int pixels = 8; pixels < 120 && number("palpateForce") < 0.3; pixels += 4) {
    move_pointer(sagittal, from + QPoint(pixels, 0));
  }
  wait_for(
      "a force is felt", [] { return number("palpateForce") > 0.2; }, 5);
  wait_ms(500);
}

void press_once() {
  vtkRenderWindowInteractor& hand = interactor("Sagittal");
  const auto send = [&](unsigned long event, const QPoint& at) {
    hand.SetEventInformation(at.x(), view("Sagittal").height() - 1 - at.y());
    hand.InvokeEvent(event);
    wait_ms(40);
  };
  turn_forces_on();
  const QPoint at = proxy_in(view("Sagittal"));
  send(vtkCommand::LeftButtonPressEvent, at);
  for (int pixels = 0; pixels < 160 && number("palpateForce") < 0.3; pixels += 2) {
    send(vtkCommand::MouseMoveEvent, at + QPoint(pixels, 0));
  }
  expect(number("palpateForce") > 0.2, "a force is felt");
  wait_ms(300);
  send(vtkCommand::LeftButtonReleaseEvent, at);
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
