#pragma once

/// Runs steps one at a time, each in its own turn of the event loop, so that the program stays responsive between them.

#include <QTimer>

#include <deque>
#include <functional>
#include <string>

namespace palpate::plugin {

class Turns {
 public:
  using Step = std::function<void()>;

  /// `failed` gets the error of a step that throws. Later steps are then dropped.
  explicit Turns(std::function<void(const std::string& error)> failed);
  Turns(const Turns&) = delete;
  Turns& operator=(const Turns&) = delete;

  void add(Step step);
  /// Runs a step at once, or after the current one. Of several waiting steps only the last is run. It must not throw.
  void alone(Step step);
  /// Drops steps that were not yet run.
  void clear();
  /// Whether a step is running. It may handle events itself; no other step runs meanwhile.
  bool is_inside() const { return inside_; }

 private:
  void take_one();
  void take_waiting();

  std::function<void(const std::string&)> failed_;
  std::deque<Step> steps_;
  Step waiting_;
  bool inside_ = false;
  QTimer timer_;  // its destructor ends pending steps
};

}  // namespace palpate::plugin
