#pragma once

/// Compares two recordings of the same stroke, place by place: a chart, and a summary in words.

#include <QWidget>

#include <memory>

#include "plugin/paraview/client/jobs/job.h"
#include "plugin/recording/recorded_session.h"
#include "plugin/report/compare_strokes.h"

namespace palpate::plugin {

class ChartPicture;

class RecordingComparison : public QWidget {
  Q_OBJECT

 public:
  struct Recording {
    QString name;
    std::shared_ptr<const RecordedSession> session;
  };

  explicit RecordingComparison(QWidget* parent = nullptr);

  /// Compares in the background, then becomes visible. Hidden if one of them is missing.
  void compare(const Recording& first, const Recording& second);

 signals:
  void told(const QString& text, bool problem);

 private:
  void show_both(std::shared_ptr<const Comparison> both);

  QString first_, second_;  // their names
  std::shared_ptr<const Comparison> both_;
  ChartPicture* chart_;
  Job job_{Job::Newer::follows};
};

}  // namespace palpate::plugin
