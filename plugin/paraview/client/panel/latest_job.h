#pragma once

/// Work in the background of which only the newest matters: while one runs, of those that are asked for the last waits.

#include <QMetaObject>
#include <QObject>
#include <QString>
#include <QThreadPool>

#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace palpate::plugin {

template <typename Result>
class LatestJob {
 public:
  using Work = std::function<Result()>;
  /// On the thread that made this; null with the error where the work threw.
  using Done = std::function<void(std::shared_ptr<const Result>, const QString& error)>;

  explicit LatestJob(Done done) : done_(std::move(done)) { pool_.setMaxThreadCount(1); }
  LatestJob(const LatestJob&) = delete;
  LatestJob& operator=(const LatestJob&) = delete;
  /// Waits for the work that runs; nothing is called any more.
  ~LatestJob() { pool_.waitForDone(); }

  void ask(Work work) {
    if (running_) {
      next_ = std::move(work);
    } else {
      start(std::move(work));
    }
  }
  /// What was asked for is not wanted any more.
  void drop() {
    next_.reset();
    ++generation_;
  }

 private:
  void start(Work work) {
    running_ = true;
    pool_.start([this, generation = generation_, work = std::move(work)] {
      std::shared_ptr<const Result> result;
      QString error;
      try {
        result = std::make_shared<const Result>(work());
      } catch (const std::exception& failure) {
        error = QString::fromUtf8(failure.what());
      }
      QMetaObject::invokeMethod(
          &receiver_, [this, generation, result, error] { finish(generation, result, error); }, Qt::QueuedConnection);
    });
  }
  void finish(int generation, const std::shared_ptr<const Result>& result, const QString& error) {
    running_ = false;
    if (next_) start(*std::exchange(next_, std::nullopt));
    if (generation == generation_) done_(result, error);
  }

  Done done_;
  bool running_ = false;
  int generation_ = 0;
  std::optional<Work> next_;
  QObject receiver_;  // its end ends what was queued
  QThreadPool pool_;  // first to go
};

}  // namespace palpate::plugin
