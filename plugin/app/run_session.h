#pragma once

/// Runs a session from beginning to end and records it: in real time on the servo thread, or as fast as possible if the
/// stylus is only simulated.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "device/link/realtime.h"
#include "device/stylus.h"
#include "modes/scene/scene.h"
#include "plugin/app/running_session.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {

struct SessionRun {
  modes::Scene scene;
  PreparedScene felt;  ///< the scene on the scan
  std::string scan_hash;
  std::string unit;                        ///< the scan's
  ScanFrame frame;                         ///< which frame of its series the scan is
  std::shared_ptr<device::Stylus> stylus;  ///< may be open; closed at the end
  std::uint64_t seed = 0;
  double seconds = 0;  ///< 0: until it is interrupted
  bool at_clock_pace = true;
  bool live = false;  ///< whether a line on stderr shows the present state
};

struct SessionRunResult {
  RecorderStatus recorder;
  device::RealtimeStatus realtime;  ///< of the servo thread, if it runs in real time
  std::uint64_t missed = 0;         ///< deadlines without a tick
  bool interrupted = false;         ///< by SIGINT or SIGTERM; the session was still ended properly
};

/// Records to the file (`<file>.partial` until the end). Throws errors of opening the stylus and the file.
SessionRunResult run_session(const SessionRun& run, const std::filesystem::path& file);

/// "2000 ticks in session.h5; missed ticks 3, ticks lost 0"
std::string in_words(const SessionRunResult& result, const std::filesystem::path& file);

/// Reports on stderr which of the scene's limits are reduced for the stylus.
void tell_drawn_down(const modes::Scene& scene, const device::Specification& stylus);

/// Whether stderr is a terminal.
bool stderr_is_terminal();

}  // namespace palpate::plugin
