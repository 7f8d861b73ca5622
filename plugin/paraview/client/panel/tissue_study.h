#pragma once

/// Looks for tissues on the scan that is felt, in the background, and proposes what it found. Shows how far it is.

#include <QProgressBar>

#include <memory>

#include "io/volume.h"
#include "plugin/paraview/client/jobs/scan_loader.h"
#include "plugin/paraview/client/model/session_controller.h"

namespace palpate::plugin {

class TissueStudy : public QProgressBar {
  Q_OBJECT

 public:
  TissueStudy(SceneModel& model, SessionController& session, QWidget* parent = nullptr);

  void study(const std::shared_ptr<const io::Volume>& volume);
  /// The scan goes.
  void cancel();

 signals:
  /// `proposed`: the scene that it suggests, where the scan lies now. It is not felt yet.
  void studied(const std::shared_ptr<const palpate::plugin::ScanStudy>& study, const palpate::modes::Scene& proposed,
               const QString& unit);

 private:
  void take(const std::shared_ptr<const ScanStudy>& study, const QString& unit);

  SceneModel& model_;
  SessionController& session_;
  std::weak_ptr<const io::Volume> studied_;  // or being studied
  ScanLoader job_;                           // last: its thread is to end before all that its callbacks use
};

}  // namespace palpate::plugin
