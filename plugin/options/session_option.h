#pragma once

/// The options that `palpate probe` and `palpate record` share: a scan, a scene, a stylus, how long.

#include <memory>
#include <string>

#include "io/volume.h"
#include "plugin/app/run_session.h"
#include "plugin/options/probe_path.h"
#include "plugin/options/series_option.h"
#include "plugin/options/stylus_option.h"

namespace CLI {
class App;
}

namespace palpate::plugin {

struct SessionOption {
  SeriesOption series;
  StylusChoice stylus;
  ProbePathOption path;
  std::string scene;
  double seconds = 0;
  bool live = false;
};
void add_session_option(CLI::App& command, SessionOption& option);

/// A session that is ready to run at the clock's pace, on its scan; a simulated hand knows its way.
struct ReadySession {
  std::shared_ptr<const io::Volume> volume;
  SessionRun run;
  bool simulated = false;  ///< the stylus is only arithmetic
};

/// Loads the scan and plans the scene. Throws what open_scan(), scene_for() and follow_probe_path() throw.
ReadySession prepare_session(const SessionOption& option, const std::shared_ptr<device::Stylus>& stylus);

}  // namespace palpate::plugin
