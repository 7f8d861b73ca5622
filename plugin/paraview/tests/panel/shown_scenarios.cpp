// The felt scan is the visible one. If no view shows the scan there is no force, and the panel says why.

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqDataRepresentation.h>
#include <pqDeleteReaction.h>
#include <pqObjectBuilder.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>
#include <pqUndoStack.h>
#include <vtkPVRenderView.h>
#include <vtkPropCollection.h>
#include <vtkRenderer.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkTextActor.h>

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QEvent>
#include <QFile>
#include <QObject>
#include <QPushButton>
#include <QTreeWidget>

#include <cstdlib>
#include <string>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// The force goes, the state says `why`, and Feel stays off.
void expect_stopped(const char* why) {
  wait_for(
      std::string("it is stopped: ") + why,
      [&] { return label("palpateState").startsWith("Stopped: ") && label("palpateState").contains(why); }, 20);
  wait_for(
      "the force is gone", [] { return number("palpateForce") == 0; }, 20);
  wait_ms(500);
  expect(number("palpateForce") == 0, "the force stays away");
  expect(!find<QPushButton>("palpateFeel").isEnabled() || find<QPushButton>("palpateFeel").text() == "Clear fault",
         "Feel cannot be pressed");
}

/// Nothing turns the force on by itself; Feel does.
void expect_ready_to_feel() {
  if (find<QPushButton>("palpateFeel").text() == "Clear fault") click("palpateFeel");
  wait_for(
      "it is ready", [] { return label("palpateState").startsWith("Ready: no force"); }, 20);
  wait_ms(700);
  expect(number("palpateForce") == 0, "no force came by itself");
  turn_forces_on();
}

void set_scan_visible(bool visible) {
  for (pqDataRepresentation* const shown : reader().getRepresentations(nullptr)) {
    shown->setVisible(visible);
    if (shown->getView()) shown->getView()->render();
  }
}

void no_scan_shown_no_force() {
  choose_series(0);
  feel();
  expect(label("palpateFelt").startsWith("Felt: CT "), "the panel names what is felt");
  save_screen("felt-named");
  set_scan_visible(false);
  expect_stopped(
      "no view shows the scan. Show it again (its eye in ParaView's list of open data, the Pipeline Browser), then "
      "press Feel");
  save_screen("no-scan-hidden");
  let_go();
  set_scan_visible(true);
  expect_ready_to_feel();

  // A second scan is active in the pipeline, and seen in a view.
  press();
  pqObjectBuilder& builder = *pqApplicationCore::instance()->getObjectBuilder();
  pqPipelineSource& first = reader();
  pqPipelineSource* const second =
      builder.createSource("sources", "PalpateDicomReader", pqActiveObjects::instance().activeServer());
  vtkSMPropertyHelper(second->getProxy(), "FileName")
      .Set(vtkSMPropertyHelper(first.getProxy(), "FileName").GetAsString());
  second->getProxy()->UpdateVTKObjects();
  second->updatePipeline();
  pqActiveObjects::instance().setActiveSource(second);
  expect_stopped("another scan, ");
  expect_stopped(", is chosen in ParaView's list of open data, the Pipeline Browser. Choose ");
  expect_stopped(" there, then press Feel");
  let_go();
  pqDataRepresentation* const also =
      builder.createDataRepresentation(second->getOutputPort(0), pqActiveObjects::instance().activeView());
  also->setVisible(true);
  wait_for(
      "it is said which one is not felt",
      [&] { return label("palpateFelt").endsWith("Also shown, not felt: " + second->getSMName() + "."); }, 20);
  save_screen("second-scan");
  pqActiveObjects::instance().setActiveSource(&first);
  expect_ready_to_feel();
  builder.destroy(second);
  views_rest();

  // The reader is deleted in mid-contact.
  press();
  builder.destroy(&first);
  expect_stopped("the scan was deleted. Open a scan, then press Feel");
  expect(find<QPushButton>("palpateConnect").text() == "Disconnect", "the stylus is still connected");
  save_screen("no-scan-deleted");
  let_go();
  choose_series(1);
  expect_ready_to_feel();
}

/// How many texts are drawn over a slice.
int texts_drawn_over(const char* name) {
  auto* const client = vtkPVRenderView::SafeDownCast(render_view(name).getRenderViewProxy()->GetClientSideView());
  vtkPropCollection& props = *client->GetNonCompositedRenderer()->GetViewProps();
  int texts = 0;
  for (int n = 0; n < props.GetNumberOfItems(); ++n) {
    texts += vtkTextActor::SafeDownCast(props.GetItemAsObject(n)) ? 1 : 0;
  }
  return texts;
}

pqPipelineSource* source_of_the_scene() {
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source->getProxy()->GetXMLName() == std::string("PalpateScene")) return source;
  }
  return nullptr;
}

/// What is deleted in the pipeline can be brought back, and is felt as before.
void a_deleted_scan_comes_back() {
  choose_series(0);
  feel();
  const QString felt = label("palpateFelt");
  expect(felt.startsWith("Felt: CT "), "the panel names what is felt");
  const int texts = texts_drawn_over("Axial");
  pqDeleteReaction::deleteSources({&reader()});
  expect_stopped("the scan was deleted. Open a scan, then press Feel");
  wait_for(
      "nothing is said to be felt", [] { return label("palpateFelt") == "No scan is open."; }, 20);
  let_go();
  pqApplicationCore::instance()->getUndoStack()->undo();
  scan_is_shown();
  expect_ready_to_feel();
  wait_for(
      "the same is felt", [&] { return label("palpateFelt") == felt; }, 20);
  for (const char* const name : {"Axial", "Sagittal", "Coronal"}) {
    expect(texts_drawn_over(name) == texts, std::string("one set of texts lies over ") + name);
    turn_wheel(name, 1);  // from now on the slices do not follow the stylus
    const auto number_of_slice = [name] { return corner_text(name).section(" / ", 0, 0).section(' ', -1).toInt(); };
    const int before = number_of_slice();
    turn_wheel(name, 1);
    expect(std::abs(number_of_slice() - before) == 1, std::string("the wheel shows the next slice in ") + name);
  }
  save_screen("scan-brought-back");

  // The scan is deleted with what keeps its scene: both come back.
  find<QDoubleSpinBox>("palpateStrength0").setValue(0.65);
  wait_for(
      "the edit is in the scene", [] { return scene_text().find("0.65") != std::string::npos; }, 20);
  const std::string edited = steady_scene();
  pqPipelineSource* const scene = source_of_the_scene();
  expect(scene != nullptr, "the scene is in the pipeline");
  pqDeleteReaction::deleteSources({&reader(), scene});
  wait_for(
      "both are gone",
      [] { return label("palpateFelt") == "No scan is open." && reader_in_pipeline() == 0 && scene_text().empty(); },
      20);
  pqApplicationCore::instance()->getUndoStack()->undo();
  another_scan_is_shown(0);
  expect(scene_text() == edited, "the scene is as it was edited");
  expect(find<QDoubleSpinBox>("palpateStrength0").value() == 0.65, "in the panel, too");
  expect_four_views_of_one_scan();
  find<QDoubleSpinBox>("palpateStrength0").setValue(0.55);
  wait_for(
      "an edit is kept there again", [] { return scene_text().find("0.55") != std::string::npos; }, 20);
}

void a_reset_session_has_no_force() {
  feel();
  pqDeleteReaction::deleteAll();
  expect_stopped("Open a scan, then press Feel");
  save_screen("no-scan-reset");
  let_go();
  wait_for("ParaView has a session again", [] { return pqActiveObjects::instance().activeServer() != nullptr; });
  wait_ms(1000);
  wait_for(
      "nothing is said to be felt", [] { return label("palpateFelt") == "No scan is open."; }, 20);
  expect(label("palpateTissue").isEmpty(), "and no value: " + label("palpateTissue").toStdString());
  drop_folder(qEnvironmentVariable("PALPATE_OPEN"));
  scan_is_shown();
  expect_ready_to_feel();
  // And where ParaView goes to another session altogether.
  press();
  pqApplicationCore::instance()->getObjectBuilder()->removeServer(pqActiveObjects::instance().activeServer());
  expect_stopped("Open a scan, then press Feel");
  let_go();
}

void a_loaded_state_has_no_force() {
  scan_is_shown();
  find<QDoubleSpinBox>("palpateStrength0").setValue(0.45);
  wait_for(
      "the edit is in the scene", [] { return scene_text().find("0.45") != std::string::npos; }, 20);
  const std::string saved = steady_scene();
  const QString file = qEnvironmentVariable("PALPATE_PICTURES") + QStringLiteral("/panel-shown.pvsm");
  expect(pqApplicationCore::instance()->saveState(file), "the state is saved");
  find<QDoubleSpinBox>("palpateStrength0").setValue(0.9);
  connect_stylus();
  press();
  pqApplicationCore::instance()->loadState(file.toUtf8().constData(), pqActiveObjects::instance().activeServer());
  wait_for(
      "the force is gone", [] { return number("palpateForce") == 0; }, 20);
  let_go();
  wait_for("the scene is the state's", [&] { return scene_text() == saved || !scene_text().empty(); });
  scan_is_shown();
  expect(find<QPushButton>("palpateConnect").text() == "Disconnect", "the stylus is still connected");
  wait_for(
      "the panel has the state's scene", [] { return find<QDoubleSpinBox>("palpateStrength0").value() == 0.45; }, 20);
  wait_for(
      "it is said where the scene is from",
      [] { return label("palpateFelt").contains("Scene: Restored from the state file."); }, 20);
  save_screen("state-loaded");
  expect_ready_to_feel();
}

/// Whether a chart was disabled, and what its axes said then.
class DisabledChart : public QObject {
 public:
  explicit DisabledChart(QWidget& chart) : chart_(chart) { chart.installEventFilter(this); }
  bool was_seen() const { return seen_; }
  const QString& axes() const { return axes_; }
  bool eventFilter(QObject*, QEvent* event) override {
    if (event->type() == QEvent::EnabledChange && !chart_.isEnabled()) {
      seen_ = true;
      axes_ = label((chart_.objectName() + QStringLiteral("Axes")).toUtf8().constData());
    }
    return false;
  }

 private:
  QWidget& chart_;
  bool seen_ = false;
  QString axes_;
};

/// What was done to one scan's scene is not undone on another's.
void undo_belongs_to_a_scan() {
  choose_series(0);
  expect(find<QComboBox>("palpateScenes").currentText() == "Found in this scan", "the scene was found in the scan");
  find<QDoubleSpinBox>("palpateStrength0").setValue(0.65);
  wait_for(
      "the scene says that it was edited",
      [] { return find<QComboBox>("palpateScenes").currentText() == "Found in this scan, edited"; }, 20);
  click("palpateCurvesSectionFold");
  click("palpateUndo");
  wait_for(
      "undone, it is what was found",
      [] { return find<QComboBox>("palpateScenes").currentText() == "Found in this scan"; }, 20);
  click("palpateRedo");
  wait_for(
      "done again", [] { return find<QComboBox>("palpateScenes").currentText() == "Found in this scan, edited"; }, 20);
  const std::string first = scene_text();
  const unsigned before = reader_in_pipeline();
  QWidget& chart = find<QWidget>("palpateStrengthCurve");
  const DisabledChart disabled(chart);
  choose_series_and(1, "Discard");
  another_scan_is_shown(before);
  expect(disabled.was_seen() && disabled.axes().isEmpty(), "no curve stands over the histogram of the scan before");
  expect(chart.isEnabled(), "the study of the other brings its own");
  const std::string second = scene_text();
  expect(second != first, "the other scan has a scene of its own");
  const bool can = find<QWidget>("palpateUndo").isEnabled();
  if (can) click("palpateUndo");
  wait_ms(800);
  expect(scene_text() == second, "the first scan's scene does not come to the second");
  expect(find<QComboBox>("palpateScenes").currentText() == "Found in this scan", "and it is the one found in it");
  // A file's scene is called by the file, and leaves the reach as it is.
  const QString file = qEnvironmentVariable("PALPATE_PICTURES") + QStringLiteral("/my scene.json");
  find<QDoubleSpinBox>("palpateStrength0").setValue(0.7);
  wait_for(
      "the edit is in the scene", [&] { return scene_text() != second; }, 20);
  save_as("palpateSaveScene", file);
  click("palpateOneToOne");
  const QString reach = steady("the reach", [] { return label("palpateScale"); });
  name_file("palpateOpenScene", file);
  wait_for(
      "the scene is called by its file",
      [] { return find<QComboBox>("palpateScenes").currentText() == "my scene.json"; }, 20);
  expect(label("palpateScale") == reach, "the reach is the user's");
  save_screen("scene-named");
  // With a stylus connected, another series gets a scene that says what it is.
  connect_stylus();
  choose_series(0);
  expect(find<QComboBox>("palpateScenes").currentText() != "my scene.json", "the file's scene was another scan's");
  wait_for(
      "the footer names the same",
      [] { return label("palpateFelt").contains("Scene: " + find<QComboBox>("palpateScenes").currentText()); }, 20);
}

std::size_t scans_in(const QString& state) {
  QFile file(state);
  expect(file.open(QIODevice::ReadOnly), "the state is there");
  return static_cast<std::size_t>(file.readAll().count("type=\"PalpateDicomReader\""));
}

/// A scan is deleted while it is felt, brought back, and another study is opened. The state has that one alone.
void what_was_deleted_is_not_in_the_state() {
  feel();
  pqDeleteReaction::deleteSources({&reader()});
  expect_stopped("the scan was deleted. Open a scan, then press Feel");
  let_go();
  pqApplicationCore::instance()->getUndoStack()->undo();
  scan_is_shown();
  const unsigned before = reader_in_pipeline();
  const QString folder = qEnvironmentVariable("PALPATE_OTHER");
  drop_folder(folder);
  another_scan_is_shown(before);
  expect_four_views_of_one_scan();
  expect(QString(vtkSMPropertyHelper(reader().getProxy(), "FileName").GetAsString()).startsWith(folder),
         "the views show the other study");
  expect(!label("palpateFelt").startsWith("Felt:"),
         "nothing is said to be felt: " + label("palpateFelt").toStdString());
  expect(find<QTreeWidget>("palpateStructureList").topLevelItemCount() == 0, "the first scan's structures are gone");
  const QString file = qEnvironmentVariable("PALPATE_PICTURES") + QStringLiteral("/other-alone.pvsm");
  expect(pqApplicationCore::instance()->saveState(file), "the state is saved");
  expect(scans_in(file) == 1, "one scan is in the state");
  save_screen("other-alone");
  expect_ready_to_feel();
}

}  // namespace

const Scenarios& shown_scenarios() {
  static const Scenarios all{
      {"no_scan_shown_no_force", no_scan_shown_no_force},
      {"a_deleted_scan_comes_back", a_deleted_scan_comes_back},
      {"a_reset_session_has_no_force", a_reset_session_has_no_force},
      {"a_loaded_state_has_no_force", a_loaded_state_has_no_force},
      {"undo_belongs_to_a_scan", undo_belongs_to_a_scan},
      {"what_was_deleted_is_not_in_the_state", what_was_deleted_is_not_in_the_state},
  };
  return all;
}
