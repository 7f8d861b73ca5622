#include "plugin/paraview/tests/panel/busy_watch.h"

#include <pqApplicationCore.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkSMRenderViewProxy.h>

#include <QAbstractEventDispatcher>

#include <functional>

BusyWatch::BusyWatch() {
  clock_.start();
  auto* const dispatcher = QAbstractEventDispatcher::instance();
  connect(dispatcher, &QAbstractEventDispatcher::awake, this, [this] {
    if (busy_) end();
    busy_ = true;
    began_ms_ = 1e-6 * static_cast<double>(clock_.nsecsElapsed());
    rendering_ms_ = 0;
  });
  connect(dispatcher, &QAbstractEventDispatcher::aboutToBlock, this, [this] {
    if (busy_) end();
    busy_ = false;
  });
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(this);
  command->SetCallback(&BusyWatch::rendered);
  for (pqRenderView* const view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>()) {
    vtkRenderWindow* const window = view->getRenderViewProxy()->GetRenderWindow();
    window->AddObserver(vtkCommand::StartEvent, command);
    window->AddObserver(vtkCommand::EndEvent, command);
  }
}

BusyWatch::~BusyWatch() {
  for (pqRenderView* const view : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqRenderView*>()) {
    vtkRenderWindow* const window = view->getRenderViewProxy()->GetRenderWindow();
    for (const auto event : {vtkCommand::StartEvent, vtkCommand::EndEvent}) {
      while (auto* const command = vtkCallbackCommand::SafeDownCast(window->GetCommand(event))) {
        if (command->GetClientData() != this) break;
        window->RemoveObserver(command);
      }
    }
  }
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

void BusyWatch::end() {
  const double whole_ms = 1e-6 * static_cast<double>(clock_.nsecsElapsed()) - began_ms_;
  longest_ms_ = std::max(longest_ms_, whole_ms);
  stretches_.push_back(whole_ms - rendering_ms_);
}

std::vector<double> BusyWatch::without_rendering() const {
  std::vector<double> sorted = stretches_;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  return sorted;
}
