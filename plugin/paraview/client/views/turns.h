#pragma once

/// Steps that are taken one at a time, each in a turn of the event loop of its own, so that the program stays alive
/// between them.

#include <QTimer>

#include <deque>
#include <functional>
#include <string>

namespace palpate::plugin {

class Turns {
 public:
  using Step = std::function<void()>;

  /// `failed` is told what a step threw. The steps after it are then dropped.
  explicit Turns(std::function<void(const std::string& error)> failed);
  Turns(const Turns&) = delete;
  Turns& operator=(const Turns&) = delete;

  void add(Step step);
  /// A step that is taken at once, or after the one that is being taken: of several that wait for it, the last. It
  /// throws nothing.
  void alone(Step step);
  /// Drops the steps that were not taken yet.
  void clear();
  /// Whether a step is being taken. It may handle events itself; no other step is taken meanwhile.
  bool is_inside() const { return inside_; }

 private:
  void take_one();
  void take_waiting();

  std::function<void(const std::string&)> failed_;
  std::deque<Step> steps_;
  Step waiting_;
  bool inside_ = false;
  QTimer timer_;  // its end ends what is still to come
};

}  // namespace palpate::plugin
