#pragma once

/// Recordings looked at again in the views, and compared with one another.

#include <QWidget>

#include <functional>
#include <memory>
#include <vector>

#include "plugin/paraview/client/jobs/job.h"
#include "plugin/paraview/client/model/playback.h"
#include "plugin/paraview/client/views/path_views.h"
#include "plugin/report/compare_strokes.h"

class QComboBox;
class QLabel;
class QPushButton;
class QSlider;
class QToolButton;

namespace palpate::plugin {

class ChartPicture;

class RecordingsSection : public QWidget {
  Q_OBJECT

 public:
  RecordingsSection(OpenViews& views, SessionController& touching, QWidget* parent = nullptr);
  ~RecordingsSection() override;

  void open(const QString& file);

 private:
  struct Opened {
    QString name;
    std::shared_ptr<const RecordedSession> session;
    std::weak_ptr<const io::Volume> scan;  ///< that it is of
  };

  QWidget* build_player();
  QWidget* build_comparison();
  void read(const QString& file, bool second);
  void take(const std::shared_ptr<const Opened>& opened, const QString& error, bool second);
  void close_all();
  void set_first(Opened opened);
  void set_second(Opened opened);
  void play_or_pause();
  void seek(double seconds);
  void show_player();
  void show_force();
  void show_comparison(std::shared_ptr<const Comparison> both, const QString& error);
  void show_paths();
  void tell(const QString& text, bool problem = false);

  SessionController& touching_;
  Playback playback_;
  Opened first_, second_;
  std::shared_ptr<const Comparison> both_;
  PathViews first_path_, second_path_;
  OpenViews::Following following_;  // of another scan the recordings are no longer
  QLabel* name_ = nullptr;
  QWidget* player_ = nullptr;
  QToolButton* play_ = nullptr;
  QSlider* slider_ = nullptr;
  QComboBox* speed_ = nullptr;
  QLabel* held_ = nullptr;  // why it cannot be played
  QLabel* time_ = nullptr;
  ChartPicture* force_ = nullptr;
  QPushButton* compare_ = nullptr;
  QWidget* comparison_ = nullptr;
  ChartPicture* chart_ = nullptr;
  QLabel* message_ = nullptr;
  Job first_job_{Job::Newer::follows}, second_job_{Job::Newer::follows}, compare_job_{Job::Newer::follows};
};

}  // namespace palpate::plugin
