#include "plugin/paraview/tests/panel/panel_steps.h"

#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqLoadStateReaction.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>
#include <pqTabbedMultiViewWidget.h>
#include <vtkAbstractVolumeMapper.h>
#include <vtkCommand.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMRenderViewProxy.h>
#include <vtkVolume.h>
#include <vtkVolumeCollection.h>

#include <QCoreApplication>
#include <QDialog>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QListWidget>
#include <QMessageBox>
#include <QMimeData>
#include <QPushButton>
#include <QTabWidget>
#include <QThread>
#include <QUrl>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <glm/geometric.hpp>
#include <optional>
#include <stdexcept>

#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/views/caster.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/testing/test_clocks.h"

using namespace palpate;

namespace {

std::string text_beside_the_scene(const char* property) {
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source->getProxy()->GetXMLName() == std::string("PalpateScene")) {
      return vtkSMPropertyHelper(source->getProxy(), property).GetAsString();
    }
  }
  return {};
}

/// The first scan of the pipeline; nullptr if there is none.
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

namespace {

void click_series(int row) {
  auto& series = find<QListWidget>("palpateSeries");
  wait_for("the series are listed", [&] { return series.count() > row; });
  scroll_to(series);
  series.scrollToItem(series.item(row));
  click(*series.viewport(), series.visualItemRect(series.item(row)).center());
}

}  // namespace

void choose_series(int row) {
  const unsigned before = reader_in_pipeline();
  click_series(row);
  another_scan_is_shown(before);
}

void choose_series_and(int row, const char* button) {
  in_dialog_of(
      "another series", [row] { click_series(row); }, [button](QDialog& question) { answer(question, button); });
}

QString answer(QDialog& question, const char* button) {
  expect(question.objectName() == "palpateUnsaved", "it is asked what becomes of what is not saved");
  const QString asked = static_cast<QMessageBox&>(question).text();
  click((std::string("palpateUnsaved") + button).c_str());
  return asked;
}

void load_state(const QString& file) {
  const unsigned before = reader_in_pipeline();
  pqLoadStateReaction::loadState(file, true);
  another_scan_is_shown(before);
}

int views_open() {
  return static_cast<int>(pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>().size());
}

void expect_four_views_of_one_scan() {
  expect(!find<QWidget>("palpateCover").isVisible(), "nothing lies over the views");
  expect(views_open() == 4, "there are four views: " + std::to_string(views_open()));
  const auto sources = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>();
  for (const char* const kind : {"PalpateDicomReader", "PalpateScene"}) {
    const auto count = std::ranges::count_if(
        sources, [kind](const pqPipelineSource* one) { return one->getProxy()->GetXMLName() == std::string(kind); });
    expect(count == 1, std::string(kind) + " is once in the pipeline, not " + std::to_string(count) + " times");
  }
  for (const char* const name : {"Axial", "Sagittal", "Coronal", "Volume"}) {
    expect(reader().getRepresentation(&render_view(name)) != nullptr, std::string(name) + " shows it");
  }
  const auto* const tabs =
      pqCoreUtilities::mainWidget()->findChild<pqTabbedMultiViewWidget*>()->findChild<QTabWidget*>();
  expect(tabs && tabs->count() == 2, "in one tab, beside the one that makes another");
}

std::string scene_text() {
  return text_beside_the_scene("Scene");
}

std::string steady_scene() {
  return steady("the scene", [] { return QString::fromStdString(scene_text()); }).toStdString();
}

std::string marks_text() {
  return text_beside_the_scene("Marks");
}

void scan_is_shown() {
  // All at once: a scan that takes another's place is being shown first, and then studied.
  wait_for("the scan is in the views, its tissues are found, and nothing is being loaded", [] {
    return find<QPushButton>("palpateConnect").isEnabled() && !find<QWidget>("palpateStudying").isVisible() &&
           !find<QWidget>("palpateProgress").isVisible();
  });
  views_rest();
}

void another_scan_is_shown(unsigned before) {
  wait_for("another scan is in the pipeline",
           [&] { return reader_in_pipeline() != 0 && reader_in_pipeline() != before; });
  scan_is_shown();
}

plugin::SessionController& panel_session() {
  auto* const session =
      static_cast<plugin::SessionController*>(find<QWidget>("PalpatePanel").findChild<QObject*>("palpateSession"));
  expect(session != nullptr, "the panel has a session");
  return *session;
}

bool forces_are_on() {
  return label("palpateState").startsWith("Feeling: forces are on");
}

void turn_forces_on() {
  auto& feel = find<QPushButton>("palpateFeel");
  wait_for("it is known what the stylus does", [] { return !label("palpateState").isEmpty(); });
  QString clicked_at;  // a press is answered later on a busy machine, and is not to be made twice
  int turns = 0;
  wait_for("forces are on", [&] {
    const QString state = label("palpateState");
    constexpr int unanswered = 200;
    if (feel.isEnabled() && !state.startsWith("Feeling") && (state != clicked_at || ++turns > unanswered)) {
      clicked_at = state;
      turns = 0;
      click("palpateFeel");  // or "Clear fault" before it
    }
    return forces_are_on();
  });
}

void stylus_rests() {
  std::optional<plugin::SessionStatus> since;
  // A panel that was busy may last have looked before the hand was moved: what counts are ticks from now on.
  const plugin::TickRing* const ticks = panel_session().live().ticks();
  const std::uint64_t from = ticks ? ticks->written() : 0;
  wait_for("the stylus rests", [&] {
    const plugin::SessionStatus& now = panel_session().last();
    if (!now.connected) return true;
    if (!now.fresh || now.tick.index < from) return false;
    constexpr double moved_mm = 0.1;
    constexpr std::uint64_t long_enough = 100;
    if (!since || now.tick.index < since->tick.index || glm::distance(now.probe_mm, since->probe_mm) > moved_mm) {
      since = now;
    }
    return now.tick.index >= since->tick.index + long_enough;
  });
}

void step_hand(QWidget& in, const char* key) {
  const glm::dvec3 before = panel_session().hand_mm();
  press_key_in(in, key);
  constexpr double half_a_step_mm = 0.5;
  wait_for(
      std::string("the key ") + key + " moves the hand",
      [&] { return glm::distance(panel_session().hand_mm(), before) > half_a_step_mm; }, 20);
}

void connect_stylus() {
  click("palpateConnect");
  turn_forces_on();
  stylus_rests();
  views_rest();
}

namespace {

std::atomic<bool> hangs{false};

class PanelClock : public plugin::ServoClock {
 public:
  PanelClock(double period_s, bool left_alone)
      : goes_on_(period_s, plugin::testing::UnhurriedClock::WithoutHeartbeat::goes_on),
        stands_still_(period_s, plugin::testing::UnhurriedClock::WithoutHeartbeat::stands_still),
        left_alone_(left_alone) {}
  Deadline wait(std::uint64_t heartbeats) noexcept override {
    return left_alone_ || hangs ? goes_on_.wait(heartbeats) : stands_still_.wait(heartbeats);
  }

 private:
  plugin::testing::UnhurriedClock goes_on_, stands_still_;
  bool left_alone_;
};

}  // namespace

std::unique_ptr<plugin::ServoClock> panel_clock(double period_s, bool left_alone) {
  return std::make_unique<PanelClock>(period_s, left_alone);
}

void hang() {
  const plugin::TickRing* const ticks = panel_session().live().ticks();
  expect(ticks != nullptr, "a stylus is connected");
  constexpr std::uint64_t enough = 3000;  // of the 2000 that a servo allows at 1 kHz
  const std::uint64_t end = ticks->written() + enough;
  hangs = true;
  for (int n = 0; n < 6000 && ticks->written() < end; ++n) QThread::msleep(10);
  hangs = false;
  expect(ticks->written() >= end, "the servo ticks while the program hangs");
}

namespace {

vtkRenderWindowInteractor& interactor(const char* name) {
  return *render_view(name).getRenderViewProxy()->GetInteractor();
}

}  // namespace

palpate::plugin::Caster& caster_of_the_volume() {
  vtkVolumeCollection& volumes = *render_view("Volume").getRenderViewProxy()->GetRenderer()->GetVolumes();
  for (int n = 0; n < volumes.GetNumberOfItems(); ++n) {
    auto* const volume = vtkVolume::SafeDownCast(volumes.GetItemAsObject(n));
    if (volume->GetMapper()->GetClassName() == std::string("Caster"))
      return static_cast<palpate::plugin::Caster&>(*volume->GetMapper());
  }
  throw std::runtime_error("the volume is cast by nothing of ours");
}

void press() {
  QWidget& sagittal = view("Sagittal");
  const QPoint from = proxy_in(sagittal);
  drag(sagittal, from, from + QPoint(4, 0), false);  // the front is on the left
  stylus_rests();
  for (int pixels = 8; pixels < 120 && number("palpateForce") < 0.3; pixels += 4) {
    move_pointer(sagittal, from + QPoint(pixels, 0));
    stylus_rests();
  }
  wait_for(
      "a force is felt", [] { return number("palpateForce") > 0.2; }, 20);
  stylus_rests();
}

void press_once() {
  vtkRenderWindowInteractor& hand = interactor("Sagittal");
  const auto send = [&](unsigned long event, const QPoint& at) {
    hand.SetEventInformation(at.x(), view("Sagittal").height() - 1 - at.y());
    hand.InvokeEvent(event);
    stylus_rests();
  };
  turn_forces_on();
  const QPoint at = proxy_in(view("Sagittal"));
  send(vtkCommand::LeftButtonPressEvent, at);
  for (int pixels = 0; pixels < 160 && number("palpateForce") < 0.3; pixels += 4) {
    send(vtkCommand::MouseMoveEvent, at + QPoint(pixels, 0));
  }
  wait_for(
      "a force is felt", [] { return number("palpateForce") > 0.2; }, 20);
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
