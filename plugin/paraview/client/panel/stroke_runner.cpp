#include "plugin/paraview/client/panel/stroke_runner.h"

#include "device/simulated/simulated_stylus.h"

namespace palpate::plugin {

std::function<Profile()> StrokeRunner::run(const WantedStroke& stroke) {
  const LiveSession& live = session_.live();
  if (!stroke.is_whole() || !live.plan()) return {};
  const device::Specification stylus =
      live.is_connected() ? live.specification() : device::SimulatedStylus().specification();
  if (prepared_.felt.volume != live.felt_scan()) prepared_ = {.felt = {.volume = live.felt_scan()}};
  prepared_.read_ahead = live.felt().structures;
  prepared_ = {.felt = prepare(live.scene(), live.scan(), stylus.workspace_half_extent, prepared_),
               .scene = live.scene()};
  // Uses the felt plan, with the stylus' present stiffness and workspace.
  return [plan = live.plan(), felt = prepared_.felt, scene = live.scene(), unit = live.scan()->unit,
          limit_n = limits_for(live.scene().limits, stylus).force, stroke] {
    Profile profile{.stroke = run_stroke(*plan, *felt.source, *stroke.from, *stroke.to, stroke.speed_mm_per_s),
                    .plan = plan,
                    .scene = scene,
                    .unit = unit,
                    .limit_n = limit_n};
    profile.met = met_along(profile, felt);
    return profile;
  };
}

}  // namespace palpate::plugin
