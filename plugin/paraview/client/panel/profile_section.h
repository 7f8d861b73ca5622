#pragma once

/// The force along a stroke between two points, as it would be felt now: it follows every edit.

#include <QWidget>

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "plugin/paraview/client/panel/latest_job.h"
#include "plugin/paraview/client/panel/save_buttons.h"
#include "plugin/paraview/client/panel/session_controller.h"
#include "plugin/paraview/client/views/path_views.h"
#include "plugin/paraview/client/views/slice_view.h"
#include "plugin/report/stroke_picture.h"

class QDoubleSpinBox;
class QLabel;
class QLineEdit;

namespace palpate::plugin {

class ChartPicture;

class ProfileSection : public QWidget {
  Q_OBJECT

 public:
  explicit ProfileSection(SessionController& touching, SceneModel& model, QWidget* parent = nullptr);
  ~ProfileSection() override;

  /// The views of a scan that has just been shown; empty: none, and the points are forgotten.
  void set_views(const std::vector<ClinicalView>& views);

 signals:
  /// Places are to be picked in the slices from now on, or no more.
  void picking(bool on);

 public slots:
  void pick(palpate::plugin::Pick what, const glm::dvec3& place);

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  struct Stroke {
    std::optional<glm::dvec3> from, to;
    bool is_whole() const { return from && to && *from != *to; }
  };

  /// A profile, and what of it is shown.
  struct Made {
    Profile profile;
    std::vector<Chart> charts;
    QString met;  ///< where which boundary is met
  };
  static Made make(Profile profile);

  QWidget* build_points();
  void set_point(std::optional<glm::dvec3> Stroke::*point, const glm::dvec3& place);
  void read_point(std::optional<glm::dvec3> Stroke::*point, const QLineEdit& field);
  void show_points(bool passing = false);
  void run();
  void show_profile(std::shared_ptr<const Made> made, const QString& error);
  void show_nothing(const QString& why);
  void point_at(double depth_mm);
  void tell(const QString& text, bool problem);

  SessionController& touching_;
  QPushButton* pick_ = nullptr;
  QLineEdit* from_ = nullptr;
  QLineEdit* to_ = nullptr;
  QDoubleSpinBox* speed_ = nullptr;
  ChartPicture* chart_ = nullptr;
  QLabel* readout_ = nullptr;
  SaveButtons save_;
  Stroke stroke_;
  PathViews path_;
  std::shared_ptr<const Made> made_;
  Prepared prepared_;  // fields of its own: the servo's stay where the stylus is
  LatestJob<Made> job_;
};

}  // namespace palpate::plugin
