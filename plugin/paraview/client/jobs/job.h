#pragma once

/// Work in the background for an object of the UI thread, which never waits for it.

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
  /// What becomes of the work that runs when other work is asked for.
  enum class Newer {
    cancels,  ///< it is cancelled; the newer begins at once beside it, because it may wait for a machine that is silent
    follows,  ///< it is finished and its result is given; then the newest begins, and what was asked between is dropped
  };
  /// Given to the work. From any thread.
  struct Control {
    /// False: the work is not wanted any more.
    std::function<bool()> keep_going;
    /// Calls a function on the thread that asked, unless the work is not wanted any more.
    std::function<void(std::function<void()>)> tell;

    /// Tells each whole percent on the thread that asked, and stops what is not wanted any more.
    io::Progress progress(std::function<void(double done)> shown) const;
  };

  explicit Job(Newer newer = Newer::cancels);
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;
  /// As finish().
  ~Job() { finish(); }

  /// `work` runs in the background, with a Control or with nothing. `done(result, error)` is called with what it
  /// returns on the thread that asked: a std::shared_ptr<const Result>, null if the work threw, and a QString that says
  /// why. It is not called for work that is not wanted any more.
  template <typename Work, typename Done>
  void ask(Work work, Done done) {
    put([work = std::make_shared<Work>(std::move(work)),
         done = std::move(done)](const Control& control) mutable -> Reply {
      const auto [result, error] = outcome_of(*std::exchange(work, nullptr), control);
      return [done, result, error] { done(result, error); };
    });
  }
  /// What was asked for is not wanted any more. Does not wait for it.
  void cancel();
  /// Cancels, and waits for what runs: for the end of the program.
  void finish();
  /// Whether what was asked for is still to come.
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
  std::shared_ptr<std::atomic<bool>> wanted_;  // whether what runs is; null: nothing runs that is
  bool running_ = false;                       // wanted or not
  std::optional<Task> next_;
  QObject receiver_;  // its end ends what was queued
  QThreadPool pool_;  // first to go
};

}  // namespace palpate::plugin
