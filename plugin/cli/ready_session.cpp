#include "plugin/cli/ready_session.h"

#include <csignal>

#include "device/simulated/simulated_stylus.h"
#include "plugin/app/open_scan.h"
#include "plugin/session/felt_limits.h"
#include "plugin/session/scan_hash.h"

namespace palpate::plugin {

ReadySession prepare_session(const SessionOption& option, const std::shared_ptr<device::Stylus>& stylus) {
  std::signal(SIGPIPE, SIG_IGN);  // the reader of the output may go: the session goes on
  // A real device's abilities are known only once it is open. It is closed with its last owner.
  const bool simulated_only = dynamic_cast<const device::SimulatedStylus*>(stylus.get()) != nullptr;
  if (!simulated_only) stylus->open();
  const io::Series series = choose_series(option.series);
  const auto volume = std::make_shared<const io::Volume>(open_scan(series, option.series.frame));
  const device::Specification specification = stylus->specification();
  const modes::Scene asked = scene_for(option.scene, *volume);
  tell_drawn_down(asked, specification);
  ReadySession ready{.volume = volume,
                     .run = {.scene = suited_to(asked, specification),
                             .felt = {},
                             .scan_hash = hash_of(*volume),
                             .unit = volume->unit,
                             .frame = {.number = option.series.frame, .count = series.frames_per_position},
                             .stylus = stylus,
                             .seed = option.stylus.seed,
                             .seconds = option.seconds,
                             .at_clock_pace = true,
                             .live = option.live || stderr_is_terminal()}};
  SessionRun& run = ready.run;
  run.felt = prepare(run.scene, volume, specification.workspace_half_extent);
  warn_of_structures(run.felt);
  if (auto* simulated = dynamic_cast<device::SimulatedStylus*>(stylus.get())) {
    ready.simulated = true;
    const double end = follow_probe_path(option.path, *volume, run.scene, run.felt, *simulated);
    run.seconds = option.seconds > 0 ? option.seconds : end;
  }
  return ready;
}

}  // namespace palpate::plugin
