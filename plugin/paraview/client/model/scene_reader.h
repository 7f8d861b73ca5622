#pragma once

/// Reads the structures that a scene needs in the background, and keeps them while their scan is felt: undoing finds
/// them again.

#include <QString>

#include <functional>
#include <memory>
#include <vector>

#include "plugin/app/live_session.h"
#include "plugin/paraview/client/jobs/job.h"

namespace palpate::plugin {

class SceneReader {
 public:
  explicit SceneReader(LiveSession& live) : live_(live) {}

  /// Offers to the session what the scene needs on a scan, and calls `done` once, with an error if it cannot be read.
  /// False: there is nothing to wait for. A scene is not read twice on the same scan: whoever asked asks again in
  /// `done`. Another scene takes the place of the one that is being read for.
  bool read(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& scan,
            std::function<void(const QString& error)> done);
  /// What is being read is not wanted any more. Returns whether anything was.
  bool cancel();

 private:
  LiveSession& live_;
  std::vector<LoadedStructure> held_;
  std::weak_ptr<const io::Volume> held_of_;
  bool was_read_ = false;  // the scene that is asked about next
  Job job_;
};

}  // namespace palpate::plugin
