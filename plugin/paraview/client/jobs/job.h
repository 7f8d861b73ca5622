#pragma once

/// Background work for an object of the UI thread, which never waits for it.

#include <QMetaObject>
#include <QObject>
#include <QString>
#include <QThreadPool>

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "io/errors.h"
#include "io/progress.h"

namespace palpate::plugin {

class Job {
 public:
  /// What happens to running work when new work is asked for.
  enum class Newer {
    cancels,  ///< it is cancelled, and the new work begins at once beside it, since it may be waiting for a silent
              ///< machine
    follows,  ///< it is finished and its result delivered; then the newest work begins, and work asked for in between
              ///< is dropped
  };
  /// Passed to the work. Usable from any thread.
  struct Control {
    /// False: the work was cancelled.
    std::function<bool()> keep_going;
    /// Calls a function on the thread that asked, unless the work was cancelled.
    std::function<void(std::function<void()>)> tell;

    /// Reports each whole percent on the thread that asked, and stops cancelled work.
    io::Progress progress(std::function<void(double done)> shown) const;
  };

  explicit Job(Newer newer = Newer::cancels);
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;
  /// As finish().
  ~Job() { finish(); }

  /// Runs `work` in the background, with a Control or without arguments. Then calls `done(result, error)` on the thread
  /// that asked: a std::shared_ptr<const Result>, null if the work threw, and a QString with the reason. `done` is not
  /// called for cancelled work.
  template <typename Work, typename Done>
  void ask(Work work, Done done) {
    put([work = std::make_shared<Work>(std::move(work)),
         done = std::move(done)](const Control& control) mutable -> Reply {
      const auto [result, error] = outcome_of(*std::exchange(work, nullptr), control);
      return [done, result, error] { done(result, error); };
    });
  }
  /// Cancels the work that was asked for, without waiting for its end.
  void cancel();
  /// Cancels, and waits for running work to end: for the end of the program.
  void finish();
  /// Whether a result is still to come.
  bool is_busy() const { return next_ || wanted_; }

 private:
  using Reply = std::function<void()>;
  using Task = std::function<Reply(const Control&)>;

  template <typename Work>
  static auto outcome_of(Work& work, const Control& control) {
    const auto run = [&] {
      if constexpr (std::is_invocable_v<Work&, const Control&>) {
        return work(control);
      } else {
        return work();
      }
    };
    std::pair<std::shared_ptr<const std::decay_t<decltype(run())>>, QString> outcome;
    try {
      outcome.first = std::make_shared<const std::decay_t<decltype(run())>>(run());
    } catch (const io::Cancelled&) {
    } catch (const std::exception& failure) {
      outcome.second = QString::fromUtf8(failure.what());
    }
    return outcome;
  }
  void put(Task task);
  void start(Task task);
  void end(const std::shared_ptr<std::atomic<bool>>& wanted, const Reply& reply);

  Newer newer_;
  std::shared_ptr<std::atomic<bool>> wanted_;  // whether the running work is wanted; null: no wanted work is running
  bool running_ = false;                       // wanted or not
  std::optional<Task> next_;
  QObject receiver_;  // its destructor drops queued calls
  QThreadPool pool_;  // destroyed first
};

}  // namespace palpate::plugin
