#pragma once

/// Background work that waits for others, such as an archive. A new question cancels the last, and nothing waits for a
/// cancelled one.

#include <QMetaObject>
#include <QObject>
#include <QString>
#include <QThreadPool>

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <utility>

#include "io/errors.h"

namespace palpate::plugin {

template <typename Result>
class Background {
 public:
  /// Passed to the work, to ask whether it is still wanted and to report progress.
  struct Job {
    /// False: it is not wanted any more. From any thread.
    std::function<bool()> keep_going;
    /// Calls a function on the thread that asked, unless the job is not wanted any more.
    std::function<void(std::function<void()>)> tell;
  };
  using Work = std::function<Result(const Job&)>;
  /// Called on the thread that asked. Null, with the error, if the work threw. Not called for cancelled work.
  using Done = std::function<void(std::shared_ptr<const Result>, const QString& error)>;

  // Several, since one that was cancelled may still wait for a machine that does not answer.
  Background() { pool_.setMaxThreadCount(4); }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;
  /// Cancels, and waits for what runs.
  ~Background() { finish(); }
  /// The same before the end.
  void finish() {
    cancel();
    pool_.waitForDone();
  }

  void ask(Work work, Done done) {
    cancel();
    const auto wanted = std::make_shared<std::atomic<bool>>(true);
    wanted_ = wanted;
    const Job job{[wanted] { return wanted->load(); },
                  [this, wanted](std::function<void()> call) { on_asker(wanted, std::move(call)); }};
    pool_.start([this, wanted, job, work = std::move(work), done = std::move(done)] {
      if (!*wanted) return;
      std::shared_ptr<const Result> result;
      QString error;
      try {
        result = std::make_shared<const Result>(work(job));
      } catch (const io::Cancelled&) {
        return;
      } catch (const std::exception& failure) {
        error = QString::fromUtf8(failure.what());
      }
      on_asker(wanted, [this, done, result, error] {
        wanted_.reset();
        done(result, error);
      });
    });
  }
  void cancel() {
    if (wanted_) *wanted_ = false;
    wanted_.reset();
  }
  bool is_busy() const { return wanted_ != nullptr; }

 private:
  void on_asker(std::shared_ptr<std::atomic<bool>> wanted, std::function<void()> call) {
    QMetaObject::invokeMethod(
        &receiver_,
        [wanted = std::move(wanted), call = std::move(call)] {
          if (*wanted) call();
        },
        Qt::QueuedConnection);
  }

  std::shared_ptr<std::atomic<bool>> wanted_;
  QObject receiver_;  // its end ends what was queued
  QThreadPool pool_;  // first to go
};

}  // namespace palpate::plugin
