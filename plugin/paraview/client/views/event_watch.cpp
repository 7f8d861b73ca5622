#include "plugin/paraview/client/views/event_watch.h"

#include <vtkCallbackCommand.h>

#include <utility>

namespace palpate::plugin {

EventWatch::EventWatch(vtkObject* watched, std::initializer_list<unsigned long> events, float priority, Handle handle)
    : watched_(watched), handle_(std::move(handle)) {
  command_->SetClientData(this);
  command_->SetCallback([](vtkObject*, unsigned long event, void* self, void*) {
    auto& watch = *static_cast<EventWatch*>(self);
    watch.command_->SetAbortFlag(watch.handle_(event) ? 1 : 0);
  });
  if (!watched_) return;
  for (const unsigned long event : events) observers_.push_back(watched_->AddObserver(event, command_, priority));
}

EventWatch::EventWatch(vtkObject* watched, unsigned long event, std::function<void()> told)
    : EventWatch(watched, {event}, 0, [told = std::move(told)](unsigned long) {
        told();
        return false;
      }) {}

EventWatch::~EventWatch() {
  if (!watched_) return;
  for (const unsigned long observer : observers_) watched_->RemoveObserver(observer);
}

}  // namespace palpate::plugin
