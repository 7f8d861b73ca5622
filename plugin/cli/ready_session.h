#pragma once

/// A session that the options of `palpate probe`, `record` and `serve` ask for, ready to run.

#include <memory>

#include "device/stylus.h"
#include "io/volume.h"
#include "plugin/app/run_session.h"
#include "plugin/cli/session_option.h"

namespace palpate::plugin {

/// At the clock's pace, on its scan; a simulated hand knows its way.
struct ReadySession {
  std::shared_ptr<const io::Volume> volume;
  SessionRun run;
  bool simulated = false;  ///< the stylus is only arithmetic
};

/// Loads the scan and plans the scene. Throws what open_scan(), scene_for() and follow_probe_path() throw.
ReadySession prepare_session(const SessionOption& option, const std::shared_ptr<device::Stylus>& stylus);

}  // namespace palpate::plugin
