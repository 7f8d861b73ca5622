#pragma once

/// A bar that shows how far something in the background is, and can cancel it. It is hidden while nothing is done.

#include <QWidget>

#include <functional>

#include "plugin/paraview/client/jobs/job.h"

class QProgressBar;

namespace palpate::plugin {

class WorkBar : public QWidget {
  Q_OBJECT

 public:
  /// `name`: of the bar; that of its button is followed by "Cancel".
  explicit WorkBar(const QString& name, QWidget* parent = nullptr);

  bool is_busy() const { return work_.is_busy(); }
  /// Another scan is shown from now on. What is told of work that runs says for whom it is.
  void leave_scan();

 signals:
  void told(const QString& message, bool problem);

 protected:
  /// What is said at the end.
  struct Said {
    QString message;
    bool problem = false;
  };
  /// For whom the next work is: the patient's name.
  void set_patient(const QString& name) { patient_ = name; }
  /// The work runs in the background; an error that it throws is told. `doing` stands in the bar. `done` is called at
  /// the end, unless there was a problem.
  void begin(const QString& doing, std::function<Said(const Job::Control&)> work, std::function<void()> done = {});
  /// From the work: so many of all are done. An empty text stays as it is.
  void tell_progress(const Job::Control& job, int done, int all, const QString& doing = {});

 private:
  void show_doing(const QString& doing);
  QString for_whom(const QString& text) const;

  QString patient_;
  bool left_ = false;  // the scan that it is of
  QProgressBar* progress_;
  Job work_;
};

}  // namespace palpate::plugin
