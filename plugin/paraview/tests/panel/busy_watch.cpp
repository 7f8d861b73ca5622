#include "plugin/paraview/tests/panel/busy_watch.h"

#include <pqApplicationCore.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>
#include <vtkCommand.h>
#include <vtkRenderWindow.h>
#include <vtkSMRenderViewProxy.h>

#include <QAbstractEventDispatcher>
#include <QCoreApplication>

#include <ctime>
#include <functional>
#include <utility>

namespace {

vtkRenderWindow& window_of(const pqRenderView& view) {
  return *view.getRenderViewProxy()->GetRenderWindow();
}

/// Of this thread, since it began.
double processor_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace

BusyWatch::BusyWatch() {
  clock_.start();
  auto* const dispatcher = QAbstractEventDispatcher::instance();
  connect(dispatcher, &QAbstractEventDispatcher::awake, this, [this] {
    if (busy_) end();
    busy_ = true;
    began_ms_ = 1e-6 * static_cast<double>(clock_.nsecsElapsed());
    event_began_ms_ = began_processor_ms_ = processor_ms();
    rendering_ms_ = 0;
  });
  connect(dispatcher, &QAbstractEventDispatcher::aboutToBlock, this, [this] {
    if (busy_) end();
    busy_ = false;
  });
  QCoreApplication::instance()->installEventFilter(this);
  rendering_->SetClientData(this);
  rendering_->SetCallback(&BusyWatch::rendered);
  pqServerManagerModel& model = *pqApplicationCore::instance()->getServerManagerModel();
  for (pqRenderView* const view : model.findItems<pqRenderView*>()) watch(*view);
  connect(&model, &pqServerManagerModel::viewAdded, this, [this](pqView* added) {
    if (auto* const view = qobject_cast<pqRenderView*>(added)) watch(*view);
  });
}

BusyWatch::~BusyWatch() {
  for (pqRenderView* const view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>()) {
    window_of(*view).RemoveObserver(rendering_);
  }
}

void BusyWatch::watch(pqRenderView& view) {
  window_of(view).AddObserver(vtkCommand::StartEvent, rendering_);
  window_of(view).AddObserver(vtkCommand::EndEvent, rendering_);
}

void BusyWatch::rendered(vtkObject*, unsigned long event, void* self, void*) {
  auto& watch = *static_cast<BusyWatch*>(self);
  const double now_ms = 1e-6 * static_cast<double>(watch.clock_.nsecsElapsed());
  if (event == vtkCommand::StartEvent) {
    watch.render_began_ms_ = now_ms;
  } else {
    watch.rendering_ms_ += now_ms - watch.render_began_ms_;
  }
}

void BusyWatch::end_event() {
  const double now_ms = processor_ms();
  events_ms_.push_back(now_ms - std::exchange(event_began_ms_, now_ms));
}

bool BusyWatch::eventFilter(QObject*, QEvent*) {
  if (busy_) end_event();
  return false;
}

void BusyWatch::end() {
  end_event();
  const double whole_ms = 1e-6 * static_cast<double>(clock_.nsecsElapsed()) - began_ms_;
  stretches_.push_back({began_ms_, whole_ms, processor_ms() - began_processor_ms_, rendering_ms_});
}

double BusyWatch::longest_with_rendering_ms() const {
  double longest = 0;
  for (const Stretch& one : stretches_) longest = std::max(longest, one.took_ms);
  return longest;
}

std::vector<double> BusyWatch::events_ms() const {
  std::vector<double> sorted = events_ms_;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  return sorted;
}

std::vector<double> BusyWatch::without_rendering() const {
  std::vector<double> sorted;
  for (const Stretch& one : stretches_) sorted.push_back(one.took_ms - one.rendering_ms);
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  return sorted;
}
