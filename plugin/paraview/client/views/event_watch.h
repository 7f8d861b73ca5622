#pragma once

/// Watches events of a VTK object (an interactor, a renderer).

#include <vtkNew.h>
#include <vtkWeakPointer.h>

#include <functional>
#include <initializer_list>
#include <vector>

class vtkCallbackCommand;
class vtkObject;

namespace palpate::plugin {

class EventWatch {
 public:
  /// Gets the event (vtkCommand::EventIds). True: the event is used, and observers after this one do not see it.
  using Handle = std::function<bool(unsigned long event)>;

  /// Watches until this or the object is destroyed. Observers with a higher priority are called earlier; ParaView's own
  /// have 0. Null: watches nothing.
  EventWatch(vtkObject* watched, std::initializer_list<unsigned long> events, float priority, Handle handle);
  /// One event, which all others see as well.
  EventWatch(vtkObject* watched, unsigned long event, std::function<void()> told);
  EventWatch(const EventWatch&) = delete;
  EventWatch& operator=(const EventWatch&) = delete;
  ~EventWatch();

 private:
  vtkWeakPointer<vtkObject> watched_;
  Handle handle_;
  vtkNew<vtkCallbackCommand> command_;
  std::vector<unsigned long> observers_;
};

}  // namespace palpate::plugin
