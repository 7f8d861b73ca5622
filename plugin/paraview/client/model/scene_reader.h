#pragma once

/// Reads the structures that a scene needs, in the background, and keeps them while their scan is felt, so that undo
/// finds them again.

#include <QString>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "plugin/app/live_session.h"
#include "plugin/paraview/client/jobs/job.h"

namespace palpate::plugin {

class SceneReader {
 public:
  explicit SceneReader(LiveSession& live) : live_(live) {}

  /// Reads what the scene needs on a scan, offers it to the session, and calls `done` once, with an error if it cannot
  /// be read. False: there is nothing to wait for. A scene is not read twice on the same scan: the caller calls again
  /// in `done`, perhaps with another scene. A newer scene replaces the one being read.
  bool read(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& scan,
            std::function<void(const QString& error)> done);
  /// Cancels the reading. Returns whether there was any.
  bool cancel();

 private:
  LiveSession& live_;
  std::vector<LoadedStructure> held_;
  std::weak_ptr<const io::Volume> held_of_;
  std::string just_read_;  // the scene, while its `done` runs
  Job job_;
};

}  // namespace palpate::plugin
