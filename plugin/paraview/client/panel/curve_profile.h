#pragma once

/// The chart below a transfer function: the force along a stroke, now and before the curve was dragged.

#include <QTimer>
#include <QWidget>

#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include "plugin/paraview/client/jobs/job.h"
#include "plugin/paraview/client/panel/stroke_runner.h"

class QLabel;

namespace palpate::plugin {

class ChartPicture;

class CurveProfile : public QWidget {
  Q_OBJECT

 public:
  CurveProfile(SessionController& session, SceneModel& model, StrokeRunner& strokes, QWidget* parent = nullptr);
  ~CurveProfile() override;

  /// The stroke that the user has chosen. Until it has two different points, the line through the latest place of
  /// point_at() or touch_at() is used.
  void choose(const WantedStroke& stroke);
  /// The pointer is at this place in a slice; `gradient` of the scan's value. The place is used once the pointer has
  /// rested, because it passes over many places on its way to the curve.
  void point_at(const glm::dvec3& place, const glm::dvec3& gradient);
  /// A boundary holds the stylus at this place; `inward`: from the proxy to the probe. Also used once the stylus has
  /// rested.
  void touch_at(const glm::dvec3& place, const glm::dvec3& inward);
  /// Another scan: forgets the previous one's places.
  void forget();
  /// A drag of the curve has ended: the next drag is compared with the present curve.
  void rest();

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  /// A line across the scan.
  struct Across {
    glm::dvec3 place{0}, inward{0};
    bool touched = false;
  };
  struct Made {
    Chart chart;
    double length_mm = 0;
    QString met;
  };
  static Made make(const Profile& profile);

  void propose(const Across& across);
  WantedStroke stroke() const;
  void run();
  void show_made();

  StrokeRunner& strokes_;
  QLabel* words_;
  ChartPicture* chart_;
  WantedStroke chosen_;
  std::optional<Across> across_, proposed_;
  QTimer rest_;
  bool dragging_ = false;
  std::shared_ptr<const Made> made_, before_;
  Job job_{Job::Newer::follows};
};

}  // namespace palpate::plugin
