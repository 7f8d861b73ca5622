#pragma once

/// The filter of the scan: what the stylus feels, and whether the views show it.

#include <QWidget>

#include <functional>
#include <memory>

#include "io/filter.h"
#include "modes/scene/scene.h"
#include "plugin/paraview/client/jobs/scan_loader.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QProgressBar;

namespace palpate::plugin {

class SceneModel;
class ScanModel;
class ScanPipeline;
class SessionController;

/// The row of the filter: the scene holds the filter, and this row asks for another one. The voxels are filtered in the
/// background; the scene is edited when they are ready. The same happens when undo brings a scene back.
class FilterRow : public QWidget {
  Q_OBJECT

 public:
  FilterRow(SceneModel& model, SessionController& session, ScanModel& scans, ScanPipeline& readers,
            QWidget* parent = nullptr);

  /// Another scan, or none.
  void refresh();
  /// The scan goes: what was chosen for it is not wanted any more. What undo brings back is.
  void give_up();
  /// "Gaussian filter of 1 mm", and what the views show where that is not the same; empty without a filter.
  QString in_words() const;

 private:
  void ask();
  bool make_ready(const modes::Scene& scene, const std::function<void()>& ready);
  void compute(const io::Filter& filter, const std::function<void()>& done);
  void cancel();
  void follow_scan();
  void follow();
  void show(const io::Filter& filter);
  void offer_amount();
  io::Filter wanted() const;
  void show_in_views();

  SceneModel& model_;
  SessionController& session_;
  ScanModel& scans_;
  ScanPipeline& readers_;
  QComboBox* type_;
  QDoubleSpinBox* amount_;
  QCheckBox* shown_;
  QProgressBar* progress_;
  QLabel* message_;
  bool brought_back_ = false;                 // what is computed is for a scene that the pipeline has already
  std::weak_ptr<const io::Volume> filtered_;  // the scan that is being filtered; through what, and what follows
  io::Filter through_;
  std::function<void()> ready_;
  ScanLoader loader_;  // last: its thread is to end before all that its callbacks use
};

}  // namespace palpate::plugin
