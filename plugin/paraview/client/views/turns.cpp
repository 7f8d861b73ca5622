#include "plugin/paraview/client/views/turns.h"

#include <exception>
#include <utility>

namespace palpate::plugin {

Turns::Turns(std::function<void(const std::string& error)> failed) : failed_(std::move(failed)) {
  // ParaView draws a view 1 ms after it is asked to: that has a turn of its own then.
  constexpr int between_ms = 5;
  timer_.setSingleShot(true);
  timer_.setInterval(between_ms);
  QObject::connect(&timer_, &QTimer::timeout, [this] { take_one(); });
}

void Turns::add(Step step) {
  steps_.push_back(std::move(step));
  if (!inside_ && !timer_.isActive()) timer_.start();
}

void Turns::alone(Step step) {
  waiting_ = std::move(step);
  if (!inside_) take_waiting();
}

void Turns::take_waiting() {
  while (waiting_) {
    const Step step = std::exchange(waiting_, {});
    inside_ = true;
    step();
    inside_ = false;
  }
  if (!steps_.empty() && !timer_.isActive()) timer_.start();
}

void Turns::clear() {
  steps_.clear();
  timer_.stop();
}

void Turns::take_one() {
  if (inside_ || steps_.empty()) return;
  const Step step = std::move(steps_.front());
  steps_.pop_front();
  std::string error;
  bool failed = false;
  inside_ = true;
  try {
    step();
  } catch (const std::exception& thrown) {
    failed = true;
    error = thrown.what();
  }
  inside_ = false;
  if (failed) {
    clear();
    failed_(error);
  }
  take_waiting();
}

}  // namespace palpate::plugin
