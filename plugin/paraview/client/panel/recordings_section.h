#pragma once

/// Plays recordings in the views, and compares them.

#include <QWidget>

#include <functional>
#include <memory>
#include <vector>

#include "plugin/paraview/client/jobs/job.h"
#include "plugin/paraview/client/model/playback.h"
#include "plugin/paraview/client/panel/recording_comparison.h"
#include "plugin/paraview/client/views/path_views.h"

class QComboBox;
class QLabel;
class QSlider;
class QToolButton;

namespace palpate::plugin {

class ChartPicture;

class RecordingsSection : public QWidget {
  Q_OBJECT

 public:
  RecordingsSection(OpenViews& views, SessionController& session, QWidget* parent = nullptr);
  ~RecordingsSection() override;

  void open(const QString& file);

 private:
  struct Opened : RecordingComparison::Recording {
    std::weak_ptr<const io::Volume> scan;  ///< its scan
  };

  QWidget* build_player();
  void read(const QString& file, bool second);
  void take(const std::shared_ptr<const Opened>& opened, const QString& error, bool second);
  void follow_frame();
  void close_all();
  void set_first(Opened opened);
  void set_second(Opened opened);
  void play_or_pause();
  void seek(double seconds);
  void show_player();
  void show_force();
  void show_paths();
  void tell(const QString& text, bool problem = false);

  SessionController& session_;
  Playback playback_;
  Opened first_, second_;
  PathViews first_path_, second_path_;
  OpenViews::Following following_;  // the recordings are dropped when another scan opens
  QLabel* name_ = nullptr;
  QWidget* player_ = nullptr;
  QToolButton* play_ = nullptr;
  QSlider* slider_ = nullptr;
  QComboBox* speed_ = nullptr;
  QLabel* held_ = nullptr;  // the reason why it cannot be played
  QLabel* time_ = nullptr;
  ChartPicture* force_ = nullptr;
  RecordingComparison* comparison_ = nullptr;
  QLabel* message_ = nullptr;
  Job first_job_{Job::Newer::follows}, second_job_{Job::Newer::follows};
};

}  // namespace palpate::plugin
