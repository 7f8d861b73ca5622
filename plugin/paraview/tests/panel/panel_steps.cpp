#include "panel_steps.h"

#include <pqApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <QPushButton>

#include "panel_rig.h"

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

void connect_stylus() {
  click("palpateConnect");
  wait_for("forces are on", [] { return label("palpateState").startsWith("active"); });
  wait_ms(1500);
}

void press() {
  QWidget& sagittal = view("Sagittal");
  const QPoint from = proxy_in(sagittal);
  drag(sagittal, from, from + QPoint(4, 0), false);  // the front is on the left
  for (int pixels = 8; pixels < 120 && number("palpateForce") < 0.3; pixels += 4) {
    move_pointer(sagittal, from + QPoint(pixels, 0));
  }
  wait_for(
      "a force is felt", [] { return number("palpateForce") > 0.2; }, 10);
  wait_ms(500);
}

void feel() {
  scan_is_shown();
  connect_stylus();
  press();
}
