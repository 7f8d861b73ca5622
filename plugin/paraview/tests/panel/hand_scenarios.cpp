// The user's actions with keys, colors and curves, checked by what is felt and seen.

#include <pqApplicationCore.h>
#include <pqObjectBuilder.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>
#include <vtkActor.h>
#include <vtkActorCollection.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkSMRenderViewProxy.h>

#include <QColorDialog>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QPointer>
#include <QWidget>

#include <cmath>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// Presses the key until it is felt, once the stylus rests after each; how often it was pressed.
int press_until_felt(QWidget& in, const char* key, double newtons) {
  int presses = 0;
  while (number("palpateForce") < newtons && presses < 60) {
    step_hand(in, key);
    ++presses;
    stylus_rests();
  }
  wait_for(
      "a force is felt", [&] { return number("palpateForce") >= 0.8 * newtons; }, 20);
  return presses;
}

/// The stylus waits in front of the patient: in the axial view, that is above.
void keys_step_in_the_views() {
  scan_is_shown();
  connect_stylus();
  QWidget& coronal = view("Coronal");
  const QPoint before = proxy_in(coronal);
  const auto across = [&] { return proxy_now(coronal).value_or(before).x(); };
  const auto down = [&] { return proxy_now(coronal).value_or(before).y(); };
  for (int n = 0; n < 10; ++n) step_hand(coronal, "Right");
  wait_for("the proxy goes to the right", [&] { return across() > before.x() + 4; });
  for (int n = 0; n < 10; ++n) step_hand(coronal, "Left");
  wait_for("and back", [&] { return std::abs(across() - before.x()) <= 3; });
  for (int n = 0; n < 8; ++n) step_hand(coronal, "Up");
  wait_for("it goes up", [&] { return down() < before.y() - 4; });
  for (int n = 0; n < 8; ++n) step_hand(coronal, "Down");
  wait_for("and down again", [&] { return std::abs(down() - before.y()) <= 3; });
  expect(number("palpateForce") == 0, "nothing was touched on the way");

  // Away from the eye, from the front: into the patient, past some of the 6.5 mm of air that the phantom has before
  // him.
  const int presses = press_until_felt(coronal, "Prior", 0.3);
  expect(presses >= 3 && presses <= 20, "a step is a millimeter: " + std::to_string(presses) + " presses");
  save_screen("keys");
  for (int n = 0; n < 10; ++n) step_hand(coronal, "Next");
  wait_for("towards the eye it is free again", [] { return number("palpateForce") < 0.02; });
}

/// *Felt boundaries* draws surfaces in their colors: the dialog changes scene, swatch and view, and undo all three.
void a_color_is_chosen() {
  scan_is_shown();
  const auto shown = [] {
    vtkRendererCollection& layers = *render_view("Volume").getRenderViewProxy()->GetRenderWindow()->GetRenderers();
    for (int layer = 0; layer < layers.GetNumberOfItems(); ++layer) {
      vtkActorCollection& actors = *vtkRenderer::SafeDownCast(layers.GetItemAsObject(layer))->GetActors();
      for (int n = 0; n < actors.GetNumberOfItems(); ++n) {
        const auto* const color = vtkActor::SafeDownCast(actors.GetItemAsObject(n))->GetProperty()->GetColor();
        if (qRound(255 * color[0]) == 0x12 && qRound(255 * color[1]) == 0x34 && qRound(255 * color[2]) == 0x56)
          return true;
      }
    }
    return false;
  };
  const std::string before = scene_text();
  auto& looks = find<QComboBox>("palpateVolumeLook");
  looks.setCurrentText(QStringLiteral("Felt boundaries"));
  emit looks.activated(looks.currentIndex());
  expect(!shown(), "the color is a new one");
  in_dialog("palpateColor0", [](QDialog& dialog) {
    auto* const colors = qobject_cast<QColorDialog*>(&dialog);
    expect(colors != nullptr, "the dialog of colors is open");
    colors->setCurrentColor(QColor(0x12, 0x34, 0x56));
    save_screen("colors");
    colors->accept();
  });
  wait_for(
      "the color is in the scene", [] { return scene_text().find("#123456") != std::string::npos; }, 20);
  expect(find<QWidget>("palpateColor0").styleSheet().contains("#123456"), "its swatch has it");
  wait_for("its surface has it", shown, 20);
  click("palpateCurvesSectionFold");
  click("palpateUndo");
  wait_for(
      "the scene is as it was", [&] { return scene_text() == before; }, 20);
  wait_for(
      "and its surface", [&] { return !shown(); }, 20);
}

/// The scene becomes another one while the dialog is open, and the rows are made anew.
void a_color_for_a_boundary_that_went() {
  scan_is_shown();
  in_dialog("palpateColor0", [](QDialog& dialog) {
    auto* const colors = qobject_cast<QColorDialog*>(&dialog);
    expect(colors != nullptr, "the dialog of colors is open");
    const QPointer<QWidget> row = &find<QWidget>("palpateColor0");
    auto& scenes = find<QComboBox>("palpateScenes");
    scenes.setCurrentIndex(1);
    emit scenes.activated(1);
    wait_for("the rows are of the other scene", [row] { return row.isNull(); });
    colors->setCurrentColor(QColor(0x12, 0x34, 0x56));
    colors->accept();
  });
  expect(scene_text().find("#123456") == std::string::npos, "no other boundary gets it");
}

/// In the Pipeline Browser, where it stands beside the scan.
void what_keeps_the_scene_is_deleted() {
  scan_is_shown();
  const std::string before = scene_text();
  auto& builder = *pqApplicationCore::instance()->getObjectBuilder();
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source->getProxy()->GetXMLName() == std::string("PalpateScene")) builder.destroy(source);
  }
  expect(scene_text().empty(), "it is gone");
  wait_for("another keeps the scene", [&] { return scene_text() == before; });
  find<QDoubleSpinBox>("palpateStrength0").setValue(1.25);
  wait_for("edits are kept there", [&] { return scene_text() != before; });
}

/// While the button is still down: what is dragged is felt at once, and is in the undo stack as one edit after it.
void a_dragged_node_is_felt() {
  scan_is_shown();
  connect_stylus();
  find<QDoubleSpinBox>("palpateStrength0").setValue(1);
  press_until_felt(view("Coronal"), "Prior", 0.6);
  const double felt = number("palpateForce");
  click("palpateCurvesSectionFold");
  QWidget& chart = find<QWidget>("palpateStrengthCurveChart");
  scroll_to(find<QWidget>("palpateStrengthCurveValue"), chart);
  // The last one: what is as steep as a boundary can be.
  const QPoint node(chart.width() - 8, chart.height() * 2 / 3);
  drag(chart, node, node, true);  // where there is none a click makes one
  wait_for(
      "a node is chosen", [] { return find<QDoubleSpinBox>("palpateStrengthCurveValue").isEnabled(); }, 20);
  const std::string before = steady_scene();
  expect(number("palpateForce") > 0.7 * felt, "it is still felt");
  drag(chart, node, QPoint(node.x(), chart.height() - 6), false);
  wait_for(
      "the force falls while the node is dragged", [&] { return number("palpateForce") < 0.6 * felt; }, 20);
  save_screen("node-dragged");
  let_go();
  wait_for(
      "the edit is in the scene", [&] { return scene_text() != before; }, 20);
}

}  // namespace

const Scenarios& hand_scenarios() {
  static const Scenarios scenarios{
      {"keys_step_in_the_views", keys_step_in_the_views},
      {"a_color_is_chosen", a_color_is_chosen},
      {"a_color_for_a_boundary_that_went", a_color_for_a_boundary_that_went},
      {"what_keeps_the_scene_is_deleted", what_keeps_the_scene_is_deleted},
      {"a_dragged_node_is_felt", a_dragged_node_is_felt},
  };
  return scenarios;
}
