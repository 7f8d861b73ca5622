// A scene that persists: saved, restored by another program, traced, undone. Results of the two programs are written to
// files that panel_test.py's caller compares.

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqObjectBuilder.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <pqRepresentation.h>
#include <pqServerManagerModel.h>
#include <vtkAlgorithm.h>
#include <vtkDataArray.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMSourceProxy.h>
#include <vtkSMTrace.h>
#include <vtkTable.h>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDoubleSpinBox>
#include <QFile>
#include <QLineEdit>
#include <QPushButton>
#include <QTimer>
#include <QWidget>

#include <cstdio>
#include <memory>
#include <string>

#include "plugin/app/run_session.h"
#include "plugin/app/scan_choice.h"
#include "plugin/paraview/common/scan_store.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"
#include "plugin/recording/replay.h"
#include "plugin/session/scan_hash.h"

namespace {

QString beside(const char* name) {
  return qEnvironmentVariable("PALPATE_PICTURES") + QLatin1Char('/') + QLatin1String(name);
}

void write(const char* name, const std::string& text) {
  QFile file(beside(name));
  expect(file.open(QIODevice::WriteOnly), std::string(name) + " can be written");
  file.write(text.data(), static_cast<qint64>(text.size()));
}

pqPipelineSource* source_of_kind(const char* kind) {
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source->getProxy()->GetXMLName() == std::string(kind)) return source;
  }
  return nullptr;
}

void append(std::string& text, const char* what, const double* numbers, int count) {
  text += what;
  for (int n = 0; n < count; ++n) {
    char number[32];
    std::snprintf(number, sizeof number, " %.17g", numbers[n]);
    text += number;
  }
  text += '\n';
}

/// Every view: what it shows, from where, and how large it is on the screen.
std::string layout_text() {
  std::string text;
  for (const char* const box : {"palpateWindow", "palpateVolumeLook"}) {
    text += find<QComboBox>(box).currentText().toStdString() + "\n";
  }
  for (const char* const name : {"Axial", "Sagittal", "Coronal", "Volume"}) {
    for (pqRenderView* const one : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>()) {
      if (one->getSMName() != QLatin1String(name)) continue;
      const QRect place(one->widget()->mapTo(one->widget()->window(), QPoint(0, 0)), one->widget()->size());
      text += std::string(name) + " at " + std::to_string(place.x()) + " " + std::to_string(place.y()) + ", " +
              std::to_string(place.width()) + " x " + std::to_string(place.height()) + "\n";
      for (const char* const key : {"CameraPosition", "CameraFocalPoint", "CameraViewUp", "CameraParallelScale"}) {
        const auto values = vtkSMPropertyHelper(one->getProxy(), key).GetDoubleArray();
        append(text, key, values.data(), static_cast<int>(values.size()));
      }
      for (pqRepresentation* const shown : one->getRepresentations()) {
        vtkSMProxy& proxy = *shown->getProxy();
        if (!proxy.GetProperty("Representation") || !shown->isVisible()) continue;
        text += std::string("shown as ") + vtkSMPropertyHelper(&proxy, "Representation").GetAsString() + ", slice " +
                std::to_string(vtkSMPropertyHelper(&proxy, "Slice").GetAsInt()) + "\n";
        for (const auto& [map, points] :
             {std::pair{"LookupTable", "RGBPoints"}, std::pair{"ScalarOpacityFunction", "Points"}}) {
          const auto values =
              vtkSMPropertyHelper(vtkSMPropertyHelper(&proxy, map).GetAsProxy(), points).GetDoubleArray();
          append(text, points, values.data(), static_cast<int>(values.size()));
        }
      }
    }
  }
  return text;
}

/// The forces of the force profile in the pipeline, every digit of them.
std::string stroke_text() {
  pqPipelineSource* const profile = source_of_kind("PalpateForceProfile");
  expect(profile != nullptr, "there is a force profile in the pipeline");
  profile->updatePipeline();
  auto* const filter = vtkAlgorithm::SafeDownCast(profile->getProxy()->GetClientSideObject());
  expect(filter != nullptr, "the force profile is in this process");
  auto* const table = vtkTable::SafeDownCast(filter->GetOutputDataObject(0));
  expect(table != nullptr && table->GetNumberOfRows() > 100, "the stroke has forces");
  auto* const forces = vtkDataArray::SafeDownCast(table->GetColumnByName("Force vector (N)"));
  std::string text;
  double largest = 0;
  for (vtkIdType n = 0; n < forces->GetNumberOfTuples(); ++n) {
    append(text, "", forces->GetTuple3(n), 3);
    largest = std::max(largest, std::abs(forces->GetTuple3(n)[1]));
  }
  expect(largest > 0.2, "something is felt on the stroke");
  return text;
}

/// A stroke from the front to the middle, in the scene that the panel has.
void add_stroke() {
  pqObjectBuilder& builder = *pqApplicationCore::instance()->getObjectBuilder();
  pqPipelineSource* const profile = builder.createFilter(
      QStringLiteral("filters"), QStringLiteral("PalpateForceProfile"), source_of_kind("PalpateDicomReader"));
  const double from[3] = {0, -30, 0}, to[3] = {0, 0, 0};
  SM_SCOPED_TRACE(PropertiesModified).arg("proxy", profile->getProxy());
  vtkSMPropertyHelper(profile->getProxy(), "Point1").Set(from, 3);
  vtkSMPropertyHelper(profile->getProxy(), "Point2").Set(to, 3);
  vtkSMPropertyHelper(profile->getProxy(), "Scene").Set(scene_text().c_str());
  profile->getProxy()->UpdateVTKObjects();
  profile->setModifiedState(pqProxy::UNMODIFIED);
}

/// Several of the panel's own edits, as the stylus' hand would have them while it feels.
void edit_the_scene() {
  auto& strength = find<QDoubleSpinBox>("palpateStrength0");
  strength.setValue(0.65);
  wait_for(
      "the edit is in the scene", [] { return scene_text().find("0.65") != std::string::npos; }, 20);
  find<QDoubleSpinBox>("palpateStiffness").setValue(700);
  wait_for(
      "the stiffness is in the scene", [] { return scene_text().find("700") != std::string::npos; }, 20);
}

void write_what_is_compared(const char* run) {
  const std::string prefix = std::string("story-") + run;
  write((prefix + "-scene.json").c_str(), scene_text());
  write((prefix + "-layout.txt").c_str(), layout_text());
  write((prefix + "-stroke.txt").c_str(), stroke_text());
}

/// Works in the panel, records what is felt, saves the state; what a user does before he goes home.
void a_session_is_saved() {
  scan_is_shown();
  edit_the_scene();
  connect_stylus();
  const QString recording = beside("story.h5");
  QFile::remove(recording);
  name_file("palpateRecord", recording);
  wait_for("it is recorded", [] { return find<QPushButton>("palpateRecord").text() == "Stop recording"; });
  wait_for("forces are on", [] { return forces_are_on(); });
  stylus_rests();
  press_once();
  stylus_rests();
  click("palpateRecord");
  wait_for("the recording is closed", [] { return find<QPushButton>("palpateRecord").text() != "Stop recording"; });
  click("palpateConnect");
  add_stroke();
  find<QComboBox>("palpateWindow").setCurrentIndex(1);
  emit find<QComboBox>("palpateWindow").activated(1);
  find<QComboBox>("palpateVolumeLook").setCurrentIndex(1);
  emit find<QComboBox>("palpateVolumeLook").activated(1);
  views_rest();
  write_what_is_compared("saved");
  expect(pqApplicationCore::instance()->saveState(beside("story.pvsm")), "the state is saved");
}

/// In a program of its own, started with the state file. The same scan, scene and layout; and on the hand's recorded
/// way the same forces to the last bit, with the scene and the scan that this program has.
void a_session_is_restored() {
  scan_is_shown();
  write_what_is_compared("restored");
  save_screen("story-restored");

  using namespace palpate;
  pqPipelineSource* const reader = source_of_kind("PalpateDicomReader");
  expect(reader != nullptr, "the scan is in the pipeline");
  const std::string path = vtkSMPropertyHelper(reader->getProxy(), "FileName").GetAsString();
  const auto catalogue = plugin::find_scans(path);
  const std::string uid = vtkSMPropertyHelper(reader->getProxy(), "SeriesUid").GetAsString();
  const auto volume = plugin::load_scan(catalogue->series[plugin::choose_scan(*catalogue, uid, path)], 0);
  const std::string scan_hash = plugin::hash_of(*volume);
  const plugin::Recording recorded = plugin::read_recording(beside("story.h5").toStdString());
  const auto frames_that_differ = [&](const std::string& scene) {
    const plugin::Replay again = plugin::replay(recorded, [&](plugin::SceneRecord record) {
      expect(record.scan_hash == scan_hash, "the scan is the one that was felt");
      record.scene = scene;
      return plugin::snapshot_of(record, volume);
    });
    expect(again.ticks > 2000, "there are seconds to be repeated");
    return again.different;
  };
  expect(frames_that_differ(scene_text()) == 0, "every force is the same to the last bit");
  find<QDoubleSpinBox>("palpateStrength0").setValue(0.3);
  wait_for(
      "the edit is in the scene", [] { return scene_text().find("0.3") != std::string::npos; }, 20);
  expect(frames_that_differ(scene_text()) > 0, "another scene is felt otherwise");
  connect_stylus();
  press_once();
}

/// Closes the window. A question, if there is one, is answered with Cancel.
bool closes_unasked() {
  bool asked = false;
  QTimer looking;
  QObject::connect(&looking, &QTimer::timeout, [&asked] {
    auto* const dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
    if (!dialog) return;
    asked = true;
    dialog->reject();
  });
  constexpr int poll_ms = 200;
  looking.start(poll_ms);
  pqCoreUtilities::mainWidget()->close();
  return !asked && !pqCoreUtilities::mainWidget()->isVisible();
}

/// In a program that has another scan open, with an edited scene: all is as in the program that began with the state.
void a_session_is_loaded() {
  scan_is_shown();
  edit_the_scene();
  load_state(beside("story.pvsm"));
  expect_four_views_of_one_scan();
  write_what_is_compared("loaded");
  save_screen("story-loaded");
  connect_stylus();
  press_once();
  expect(label("palpateFelt").contains("Scene: Restored from the state file."), "the state's scene is felt");
  expect(closes_unasked(), "what is in the state file is saved");
}

/// All that one does is traced; pvpython repeats it.
void a_session_is_traced() {
  // Before the folder is opened: PALPATE_OPEN is not set for this one.
  wait_for("the panel waits for a scan", [] { return find<QPushButton>("palpateOpen").isEnabled(); });
  vtkSMTrace* const trace = vtkSMTrace::StartTrace();
  trace->SetPropertiesToTraceOnCreate(vtkSMTrace::RECORD_MODIFIED_PROPERTIES);
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  scan_is_shown();
  edit_the_scene();
  connect_stylus();
  press_once();
  stylus_rests();
  click("palpateConnect");
  add_stroke();
  write_what_is_compared("traced");
  write("story-trace.py", vtkSMTrace::StopTrace());
}

/// Twenty edits of every kind that the panel makes, and back.
void twenty_edits_are_undone() {
  scan_is_shown();
  const std::string before = scene_text();
  std::vector<std::string> texts{before};
  const auto done = [&](const std::string& what) {
    wait_for(
        what + " is in the scene", [&] { return scene_text() != texts.back(); }, 20);
    texts.push_back(scene_text());
  };
  for (int n = 0; n < 5; ++n) {
    find<QDoubleSpinBox>("palpateStrength0").setValue(0.3 + 0.05 * n);
    done("a strength");
    find<QDoubleSpinBox>("palpateStiffness").setValue(610 + 50 * n);
    done("a stiffness");
    click("palpateOn0");
    done("a switch");
    auto& name = find<QLineEdit>("palpateName0");
    name.setText(QStringLiteral("skin %1").arg(n));
    emit name.editingFinished();
    done("a name");
  }
  expect(texts.size() == 21, "there were twenty edits");
  click("palpateCurvesSectionFold");
  for (std::size_t n = texts.size() - 1; n-- > 0;) {
    click("palpateUndo");
    wait_for(
        "edit " + std::to_string(n + 1) + " is undone", [&] { return scene_text() == texts[n]; }, 20);
  }
  for (std::size_t n = 1; n < texts.size(); ++n) {
    click("palpateRedo");
    wait_for(
        "edit " + std::to_string(n) + " is done again", [&] { return scene_text() == texts[n]; }, 20);
  }
  expect(find<QDoubleSpinBox>("palpateStrength0").value() == 0.5, "the panel shows it");
}

}  // namespace

const Scenarios& story_scenarios() {
  static const Scenarios scenarios{
      {"a_session_is_saved", a_session_is_saved},           {"a_session_is_restored", a_session_is_restored},
      {"a_session_is_loaded", a_session_is_loaded},         {"a_session_is_traced", a_session_is_traced},
      {"twenty_edits_are_undone", twenty_edits_are_undone},
  };
  return scenarios;
}
