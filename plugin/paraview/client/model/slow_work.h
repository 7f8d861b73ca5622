#pragma once

/// Remembers the latest long work of the panel's thread, as the reason why the panel did not answer.

#include <QString>

#include <chrono>
#include <optional>

namespace palpate::plugin {

class SlowWork {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `what` in words, such as "drawing"; it has just ended.
  void note(const QString& what, double seconds, Time ended = std::chrono::steady_clock::now());
  /// "drawing took 2.3 s", if it ended a short while ago and took more than a fraction of the time after which the
  /// force is removed; empty: unknown.
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
