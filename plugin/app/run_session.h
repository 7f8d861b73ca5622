#pragma once

/// Runs a session from beginning to end and records it: at the clock's pace on the servo thread, or as fast as possible
/// if the stylus is only simulated.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "device/link/realtime.h"
#include "device/stylus.h"
#include "modes/scene/scene.h"
#include "plugin/recording/recorder.h"
#include "plugin/session/scan.h"
#include "plugin/session/session.h"
#include "plugin/session/structure_files.h"

namespace palpate::plugin {

struct SessionRun {
  modes::Scene scene;
  PreparedScene felt;  ///< the scene on the scan
  std::string scan_hash;
  std::string unit;                        ///< the scan's
  ScanFrame frame;                         ///< which one of its series the scan is
  std::shared_ptr<device::Stylus> stylus;  ///< may be open; closed at the end
  std::uint64_t seed = 0;
  double seconds = 0;  ///< 0: until it is interrupted
  bool at_clock_pace = true;
  bool live = false;  ///< a line on stderr that is written over
};

struct SessionRunResult {
  RecorderStatus recorder;
  device::RealtimeStatus realtime;  ///< of the servo thread, at the clock's pace
  std::uint64_t missed = 0;         ///< deadlines without a tick
  bool interrupted = false;         ///< by SIGINT or SIGTERM: ended in good order
};

/// Records to the file (`<file>.partial` until the end). Throws what opening the stylus and the file throws.
SessionRunResult run_session(const SessionRun& run, const std::filesystem::path& file);

/// "2000 ticks in session.h5; missed ticks 3, ticks lost 0"
std::string in_words(const SessionRunResult& result, const std::filesystem::path& file);

/// The scene with its coupling no stiffer than the stylus renders stably (device/safety/stiffness.h). Says on stderr
/// what of its limits is drawn down.
modes::Scene suited_to(modes::Scene scene, const device::Specification& stylus);

/// The snapshot of a scene on a scan for a stylus.
Snapshot snapshot_of(const modes::Scene& scene, const PreparedScene& felt, const device::Specification& stylus);

/// The snapshot of a recorded scene, on the scan that it was recorded on, with its structures from these files. Throws
/// std::invalid_argument if the scene is invalid, or if a structure is in none of the files.
Snapshot snapshot_of(const SceneRecord& record, const std::shared_ptr<const io::Volume>& volume, StructureFiles& files);
/// The same of a scene without structures, or with those of this machine's.
Snapshot snapshot_of(const SceneRecord& record, const std::shared_ptr<const io::Volume>& volume);

/// Whether stderr is a terminal.
bool stderr_is_terminal();

}  // namespace palpate::plugin
