#pragma once

/// A bar with the progress of background work and a button to cancel it. Hidden while there is no work.

#include <QWidget>

#include <functional>

#include "plugin/paraview/client/jobs/job.h"

class QProgressBar;

namespace palpate::plugin {

class WorkBar : public QWidget {
  Q_OBJECT

 public:
  /// `name`: of the bar; its button's name is this with "Cancel" appended.
  explicit WorkBar(const QString& name, QWidget* parent = nullptr);

  bool is_busy() const { return work_.is_busy(); }
  /// Another scan is shown from now on. Messages of running work then name its patient.
  void leave_scan();

 signals:
  void told(const QString& message, bool problem);

 protected:
  /// The message at the end of work.
  struct Said {
    QString message;
    bool problem = false;
  };
  /// The patient's name for the next work.
  void set_patient(const QString& name) { patient_ = name; }
  /// Runs the work in the background; an error that it throws is shown. `doing`: the text in the bar. `done` is called
  /// at the end, unless there was a problem.
  void begin(const QString& doing, std::function<Said(const Job::Control&)> work, std::function<void()> done = {});
  /// Called by the work: `done` of `all` steps are complete. An empty text leaves the present one.
  void tell_progress(const Job::Control& job, int done, int all, const QString& doing = {});

 private:
  void show_doing(const QString& doing);
  QString for_whom(const QString& text) const;

  QString patient_;
  bool left_ = false;  // the work's scan is no longer shown
  QProgressBar* progress_;
  Job work_;
};

}  // namespace palpate::plugin
