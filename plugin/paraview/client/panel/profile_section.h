#pragma once

/// The force along a stroke between two points, with the scene as it is now; updated after every edit.

#include <QWidget>

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "plugin/paraview/client/jobs/job.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/panel/stroke_runner.h"
#include "plugin/paraview/client/views/path_views.h"
#include "plugin/paraview/client/views/slice_view.h"
#include "plugin/paraview/client/widgets/save_buttons.h"
#include "plugin/report/stroke_picture.h"

class QDoubleSpinBox;
class QLabel;
class QLineEdit;

namespace palpate::plugin {

class ChartPicture;

class ProfileSection : public QWidget {
  Q_OBJECT

 public:
  ProfileSection(OpenViews& views, SessionController& session, SceneModel& model, StrokeRunner& strokes,
                 QWidget* parent = nullptr);
  ~ProfileSection() override;

 signals:
  /// Whether points are to be picked in the slices.
  void picking(bool on);
  /// The points or the speed have changed.
  void stroke_changed(const palpate::plugin::WantedStroke& stroke);

 public slots:
  void pick(palpate::plugin::Pick what, const glm::dvec3& place);

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  /// A profile, and its part that is shown.
  struct Made {
    Profile profile;
    std::vector<Chart> charts;
    QString met;  ///< the boundaries met, and where
  };
  static Made make(Profile profile);

  QWidget* build_points();
  void forget();
  void set_point(std::optional<glm::dvec3> WantedStroke::*point, const glm::dvec3& place);
  void read_point(std::optional<glm::dvec3> WantedStroke::*point, const QLineEdit& field);
  void show_points(bool passing = false);
  void change();
  void run();
  void show_profile(std::shared_ptr<const Made> made, const QString& error);
  void show_nothing(const QString& why);
  void point_at(double depth_mm);
  void tell(const QString& text, bool problem);

  SessionController& session_;
  StrokeRunner& strokes_;
  QPushButton* pick_ = nullptr;
  QLineEdit* from_ = nullptr;
  QLineEdit* to_ = nullptr;
  QDoubleSpinBox* speed_ = nullptr;
  ChartPicture* chart_ = nullptr;
  QLabel* readout_ = nullptr;
  SaveButtons save_;
  WantedStroke stroke_;
  PathViews path_;
  std::shared_ptr<const Made> made_;
  OpenViews::Following following_;  // the points are dropped when another scan opens
  Job job_{Job::Newer::follows};
};

}  // namespace palpate::plugin
