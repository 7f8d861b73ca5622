#pragma once

/// The filter of the scan: which one is felt, and whether the views show it.

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

/// The row of the filter. The scene holds the filter, and this row requests another one: the voxels are filtered in the
/// background, and the scene is edited when they are ready. The same happens when undo restores a scene.
class FilterRow : public QWidget {
  Q_OBJECT

 public:
  FilterRow(SceneModel& model, SessionController& session, ScanModel& scans, ScanPipeline& readers,
            QWidget* parent = nullptr);

  /// Another scan, or none.
  void refresh();
  /// The scan is closed: cancels a requested filter, but not one that undo restores.
  void give_up();
  /// "Gaussian filter of 1 mm", and what the views show if they differ; empty without a filter.
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
  bool brought_back_ = false;  // the filter being computed belongs to a scene that is already in the pipeline
  std::weak_ptr<const io::Volume> filtered_;  // the scan that is being filtered
  io::Filter through_;
  std::function<void()> ready_;
  ScanLoader loader_;  // last: its thread must end before the members that its callbacks use are destroyed
};

}  // namespace palpate::plugin
