// The appearance of the volume that a user chooses.

#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqRenderView.h>
#include <pqRepresentation.h>
#include <pqServerManagerModel.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QImage>

#include <string>
#include <vector>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// Opacity of the volume over its values, as it is shown.
std::vector<double> volume_opacity() {
  for (auto* const one : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>()) {
    if (one->getSMName() != QLatin1String("Volume")) continue;
    for (pqRepresentation* const shown : one->getRepresentations()) {
      vtkSMProxy& proxy = *shown->getProxy();
      if (!shown->isVisible() || !proxy.GetProperty("ScalarOpacityFunction")) continue;
      return vtkSMPropertyHelper(vtkSMPropertyHelper(&proxy, "ScalarOpacityFunction").GetAsProxy(), "Points")
          .GetDoubleArray();
    }
  }
  return {};
}

/// The fraction of the volume view's pixels that are not black. Its letters and marker are a fiftieth.
double shown_part() {
  const QImage picture = view("Volume").grab().toImage();
  int shown = 0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      shown += picture.pixelColor(x, y).value() > 40 ? 1 : 0;
    }
  }
  return static_cast<double>(shown) / (picture.width() * picture.height());
}

/// A chosen look stays while a scene is tuned. *Felt boundaries* draws surfaces and does not change the other look.
void a_chosen_look_stays() {
  scan_is_shown();
  auto& looks = find<QComboBox>("palpateVolumeLook");
  expect(looks.currentText() == "CT skin", "a body in air is shown by its skin");
  const auto choose = [&](const char* look) {
    looks.setCurrentText(QLatin1String(look));
    emit looks.activated(looks.currentIndex());
  };
  const std::vector<double> skin = volume_opacity();
  choose("CT bone");
  wait_for(
      "it is shown as chosen", [&] { return !volume_opacity().empty() && volume_opacity() != skin; }, 20);
  views_rest();
  const std::vector<double> bone = volume_opacity();
  auto& strength = find<QDoubleSpinBox>("palpateStrength0");
  strength.setValue(strength.value() / 2);
  wait_ms(1000);
  expect(volume_opacity() == bone, "tuning leaves the look that was chosen");
  const QImage in_bone = view("Volume").grab().toImage();
  choose("Felt boundaries");
  wait_for(
      "the boundaries are shown where that is chosen", [&] { return view("Volume").grab().toImage() != in_bone; }, 20);
  expect(comes_true([] { return shown_part() > 0.05; }), "they are seen: " + std::to_string(shown_part()));
  save_screen("felt-boundaries");
}

}  // namespace

const Scenarios& look_scenarios() {
  static const Scenarios scenarios{{"a_chosen_look_stays", a_chosen_look_stays}};
  return scenarios;
}
