#pragma once

/// What kept the panel from answering: the last work that held its thread for long.

#include <QString>

#include <chrono>
#include <optional>

namespace palpate::plugin {

class SlowWork {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `what` in words, as "drawing"; it has just ended.
  void note(const QString& what, double seconds, Time ended = std::chrono::steady_clock::now());
  /// "drawing took 2.3 s", where that ended a short while ago and took more than a fraction of the time after which the
  /// force goes; empty: it is not known.
  QString in_words(Time now = std::chrono::steady_clock::now()) const;

 private:
  struct Work {
    QString what;
    double seconds = 0;
    Time ended;
  };
  std::optional<Work> slowest_;
};

}  // namespace palpate::plugin
