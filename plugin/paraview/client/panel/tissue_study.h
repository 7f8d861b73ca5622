#pragma once

/// Searches tissues in the felt scan, in the background, and proposes a scene. Shows the progress.

#include <QProgressBar>

#include <memory>
#include <optional>

#include "io/volume.h"
#include "plugin/paraview/client/jobs/scan_loader.h"
#include "plugin/paraview/client/model/session_controller.h"

namespace palpate::plugin {

class TissueStudy : public QProgressBar {
  Q_OBJECT

 public:
  TissueStudy(SceneModel& model, SessionController& session, QWidget* parent = nullptr);

  void study(const std::shared_ptr<const io::Volume>& volume);
  /// Another frame of the scan: only its histograms and places are wanted. The scene proposed is the first frame's.
  void study_frame(const std::shared_ptr<const io::Volume>& volume);
  /// The scan is closed.
  void cancel();

 signals:
  void studied(const std::shared_ptr<const palpate::plugin::ScanStudy>& study, const QString& unit);
  /// The scene found in the scan, with the workspace of the present one. It is not felt yet. None: nothing was found.
  void proposed(const std::optional<palpate::modes::Scene>& scene);

 private:
  void begin(const std::shared_ptr<const io::Volume>& volume);
  void take(const std::shared_ptr<const ScanStudy>& study, const QString& unit);

  SceneModel& model_;
  SessionController& session_;
  std::weak_ptr<const io::Volume> studied_;  // or being studied
  bool proposes_ = false;                    // a scene is still to be proposed
  ScanLoader job_;  // last: its thread must end before the members that its callbacks use are destroyed
};

}  // namespace palpate::plugin
