#pragma once

/// Background work of which only the newest request matters. While one job runs, only the last of the requests that
/// come meanwhile waits.

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
  /// Called on the thread that made this. Null, with the error, if the work threw.
  using Done = std::function<void(std::shared_ptr<const Result>, const QString& error)>;

  explicit LatestJob(Done done) : done_(std::move(done)) { pool_.setMaxThreadCount(1); }
  LatestJob(const LatestJob&) = delete;
  LatestJob& operator=(const LatestJob&) = delete;
  /// Waits for the running work. Nothing is called after that.
  ~LatestJob() { pool_.waitForDone(); }

  void ask(Work work) {
    if (running_) {
      next_ = std::move(work);
    } else {
      start(std::move(work));
    }
  }
  /// Whether what was asked for is still to come.
  bool is_busy() const { return next_.has_value() || (running_ && running_generation_ == generation_); }
  /// Drops what was asked for.
  void drop() {
    next_.reset();
    ++generation_;
  }

 private:
  void start(Work work) {
    running_ = true;
    running_generation_ = generation_;
    pool_.start([this, generation = generation_, work = std::move(work)]() mutable {
      std::shared_ptr<const Result> result;
      QString error;
      try {
        result = std::make_shared<const Result>(work());
      } catch (const std::exception& failure) {
        error = QString::fromUtf8(failure.what());
      }
      work = nullptr;  // what it holds may be used by the other thread from now on
      QMetaObject::invokeMethod(
          &receiver_, [this, generation, result = std::move(result), error] { finish(generation, result, error); },
          Qt::QueuedConnection);
    });
  }
  void finish(int generation, const std::shared_ptr<const Result>& result, const QString& error) {
    running_ = false;
    if (next_) start(*std::exchange(next_, std::nullopt));
    if (generation == generation_) done_(result, error);
  }

  Done done_;
  bool running_ = false;
  int generation_ = 0, running_generation_ = 0;
  std::optional<Work> next_;
  QObject receiver_;  // its end ends what was queued
  QThreadPool pool_;  // first to go
};

}  // namespace palpate::plugin
