#pragma once

/// A session for `palpate probe`, `record` and `serve`, ready to run.

#include <memory>

#include "device/stylus.h"
#include "io/volume.h"
#include "plugin/app/run_session.h"
#include "plugin/cli/session_option.h"

namespace palpate::plugin {

/// Runs at the clock's pace, on its scan; a simulated hand has its path.
struct ReadySession {
  std::shared_ptr<const io::Volume> volume;
  SessionRun run;
  bool simulated = false;  ///< the stylus exists only in software
};

/// Loads the scan and plans the scene. From now on a closed output pipe does not end the program. Throws as
/// open_scan(), scene_for() and follow_probe_path() do.
ReadySession prepare_session(const SessionOption& option, const std::shared_ptr<device::Stylus>& stylus);

}  // namespace palpate::plugin
