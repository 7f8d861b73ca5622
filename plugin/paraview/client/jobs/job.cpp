#include "plugin/paraview/client/jobs/job.h"

namespace palpate::plugin {
namespace {

constexpr int most_at_once = 4;  // of which all but one are cancelled

}  // namespace

io::Progress Job::Control::progress(std::function<void(double done)> shown) const {
  return [keep_going = keep_going, tell = tell, shown = std::move(shown),
          told = std::make_shared<std::atomic<int>>(-1)](double part) {
    const int percent = static_cast<int>(100 * part);
    if (told->exchange(percent) != percent) tell([shown, part] { shown(part); });
    return keep_going();
  };
}

Job::Job(Newer newer) : newer_(newer) {
  pool_.setMaxThreadCount(newer == Newer::follows ? 1 : most_at_once);
}

void Job::put(Task task) {
  if (newer_ == Newer::follows && running_) {
    next_ = std::move(task);
    return;
  }
  cancel();
  start(std::move(task));
}

void Job::cancel() {
  next_.reset();
  if (wanted_) *wanted_ = false;
  wanted_.reset();
}

void Job::finish() {
  cancel();
  pool_.waitForDone();
}

void Job::start(Task task) {
  running_ = true;
  const auto wanted = std::make_shared<std::atomic<bool>>(true);
  wanted_ = wanted;
  const auto on_asker = [this](std::function<void()> call) {
    QMetaObject::invokeMethod(&receiver_, std::move(call), Qt::QueuedConnection);
  };
  const Control control{[wanted] { return wanted->load(); },
                        [wanted, on_asker](std::function<void()> call) {
                          on_asker([wanted, call = std::move(call)] {
                            if (*wanted) call();
                          });
                        }};
  pool_.start([this, wanted, on_asker, control, task = std::move(task)]() mutable {
    Reply reply = *wanted ? task(control) : Reply();
    task = nullptr;  // what it holds may be used by the other thread from now on
    on_asker([this, wanted, reply = std::move(reply)] { end(wanted, reply); });
  });
}

/// A reply may destroy this: it is the last.
void Job::end(const std::shared_ptr<std::atomic<bool>>& wanted, const Reply& reply) {
  if (wanted_ == wanted) wanted_.reset();
  running_ = false;
  if (next_) start(*std::exchange(next_, std::nullopt));
  if (*wanted && reply) reply();
}

}  // namespace palpate::plugin
